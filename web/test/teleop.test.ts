import { describe, expect, it } from "vitest";
import { readGamepad } from "../src/teleop/gamepad";
import { FRAME_PERIOD, type Inputs, REST, TeleopSampler, stickOf } from "../src/teleop/sampler";

const inputs = (change: Partial<Inputs> = {}): Inputs => ({
  keys: new Set(),
  deadMan: true,
  pad: null,
  gamepad: null,
  limit: 1,
  ...change,
});
const keys = (...codes: string[]) => new Set(codes);

describe("a stick position", () => {
  it("is zero without the dead-man, whatever is pressed", () => {
    expect(stickOf(inputs({ deadMan: false, keys: keys("KeyW") }))).toEqual(REST);
  });

  it("follows the keys within the limit", () => {
    expect(stickOf(inputs({ keys: keys("KeyW", "KeyQ"), limit: 0.5 }))).toEqual({ forward: 0.5, left: 0, turn: 0.5 });
    expect(stickOf(inputs({ keys: keys("KeyW", "KeyS") })).forward).toBe(0);
    expect(stickOf(inputs({ keys: keys("KeyW", "ArrowUp") })).forward).toBe(1);
  });

  it("never leaves -1..1 and takes nonsense as rest", () => {
    const gamepad = { forward: NaN, left: -7, turn: Infinity };
    expect(stickOf(inputs({ gamepad, limit: 3 }))).toEqual({ forward: 0, left: -1, turn: 0 });
  });
});

describe("the sampler", () => {
  it("sends 20 frames a second while the dead-man is held", () => {
    const sampler = new TeleopSampler();
    let frames = 0;
    for (let k = 0; k < 1000; k++) if (sampler.sample(inputs(), k / 1000) !== null) frames++;
    expect(frames).toBe(1 / FRAME_PERIOD);
  });

  it("says three times that the dead-man was let go, at once, then nothing", () => {
    const sampler = new TeleopSampler();
    sampler.sample(inputs({ keys: keys("KeyW") }), 0);
    const frames = [1, 2, 3, 4, 5].map((k) =>
      sampler.sample(inputs({ deadMan: false, keys: keys("KeyW") }), 0.001 * k),
    );
    expect(frames.slice(0, 3)).toEqual([1, 2, 3].map(() => ({ dead_man: false, ...REST })));
    expect(frames.slice(3)).toEqual([null, null]);
  });

  it("says nothing before the dead-man was ever held", () => {
    expect(new TeleopSampler().sample(inputs({ deadMan: false }), 0)).toBeNull();
  });
});

describe("a gamepad", () => {
  const pad = (axes: number[], pressed: number[] = []) =>
    ({
      id: "stick",
      connected: true,
      axes,
      buttons: Array.from({ length: 8 }, (_, k) => ({ pressed: pressed.includes(k) })),
    }) as unknown as Gamepad;

  it("drives only with a shoulder button", () => {
    expect(readGamepad([pad([0, -1, 0])])?.stick).toEqual(REST);
    expect(readGamepad([null, pad([0, -1, 0], [4])])?.stick.forward).toBeCloseTo(1);
  });

  it("rests within the dead zone and is gone when unplugged", () => {
    expect(readGamepad([pad([0.1, 0.05, -0.1], [5])])?.stick).toEqual(REST);
    expect(readGamepad([null, null])).toBeNull();
  });
});
