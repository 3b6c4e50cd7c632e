import { beforeEach, describe, expect, it } from "vitest";
import { expectReturn, tellLossOfControl } from "../src/console/controlLoss";
import { receive } from "../src/console/receive";
import { INITIAL, useConsole, type ConsoleState } from "../src/console/store";
import type { Incoming } from "../src/protocol/wire";

const hello = { type: "hello", operator: "ada", role: "operator" } as unknown as Incoming;
const selected: Incoming = { type: "selected", robot: "a" };
const lease = (holder: string): Incoming => ({
  type: "value", robot: "a", key: "state/lease", kind: "", stamp_ns: 0, age_s: 0,
  value: { holder, epoch: 1, seconds_left: 2 },
});

let state: ConsoleState;

function hear(now: number, ...messages: Incoming[]): void {
  const before = state;
  state = { ...receive(before, messages, now), now };
  tellLossOfControl(before, state);
}

const notices = () => useConsole.getState().notices.map(({ severity, text }) => `${severity}: ${text}`);

describe("an outage while this page has control", () => {
  beforeEach(() => {
    useConsole.setState({ notices: [] });
    state = { ...INITIAL, connection: "open", selected: "a" };
    hear(1000, hello, selected, lease("ada"));
    expectReturn(3000);
  });

  it("is told of on return: for how long, and that the robot stopped by itself", () => {
    hear(13_000, hello);
    expect(notices()).toEqual([]);
    hear(13_100, selected, lease(""));
    expect(notices()).toEqual([
      "warning: The robot was not heard from here for 12 s. It stopped by itself and holds still; you no longer have control.",
    ]);
    hear(13_200, lease(""));
    expect(notices()).toHaveLength(1);
  });

  it("names who has control now", () => {
    hear(4000, hello, selected, lease("bob"));
    expect(notices()[0]).toContain("stopped by itself; bob has control now");
  });

  it("was too short to lose control", () => {
    hear(2400, hello, selected, lease("ada"));
    expect(notices()).toEqual(["info: The robot was not heard from here for 1 s. You still have control."]);
  });
});

it("is not told of by a page that had no control", () => {
  useConsole.setState({ notices: [] });
  state = { ...INITIAL, connection: "open", selected: "a" };
  hear(50_000, hello, selected, lease("bob"));
  expectReturn(51_000);
  hear(60_000, hello, selected, lease(""));
  expect(notices()).toEqual([]);
});
