import { describe, expect, it } from "vitest";
import { receive } from "../src/console/receive";
import { INITIAL } from "../src/console/store";
import { retryDelay } from "../src/protocol/reconnectingSocket";
import { type Incoming, type ValueFrame, parseFrame } from "../src/protocol/wire";

const value = (key: string, content: unknown, robot = "a", age_s = 0): ValueFrame => ({
  type: "value",
  robot,
  key,
  kind: "",
  stamp_ns: 0,
  age_s,
  value: content,
});
const selected: Incoming = { type: "selected", robot: "a" };

describe("the store", () => {
  it("keeps the newest value of a key with the time at which the console had it", () => {
    const state = receive(INITIAL, [selected, value("k", 1), value("k", 2, "a", 0.25)], 1000);
    expect(state.values["k"]).toEqual({ value: 2, received: 750 });
  });

  it("ignores values of another robot", () => {
    expect(receive(INITIAL, [selected, value("k", 1, "b")], 0).values).toEqual({});
  });

  it("voids everything when another robot is selected, and what it is told to forget", () => {
    const state = receive(INITIAL, [selected, value("tele/map/tile/0_0", 1), value("tele/state", 2)], 0);
    const forgotten = receive(state, [{ type: "forget", robot: "a", keys: ["tele/map/tile/*"] }], 0);
    expect(Object.keys(forgotten.values)).toEqual(["tele/state"]);
    expect(receive(state, [{ type: "selected", robot: "b" }], 0).values).toEqual({});
  });

  it("measures the way to the console and back by what comes back", () => {
    expect(receive(INITIAL, [{ type: "pong", t: 900 }], 1000).roundTrip).toBeCloseTo(0.1);
  });

  it("makes values older when the way is slow", () => {
    const slow = { ...INITIAL, selected: "a", roundTrip: 2 };
    expect(receive(slow, [value("k", 1)], 5000).values["k"]?.received).toBe(3000);
    expect(receive({ ...slow, roundTrip: 0.1 }, [value("k", 1)], 5000).values["k"]?.received).toBe(5000);
  });

  it("ignores messages it does not know", () => {
    expect(receive(INITIAL, [{ type: "novelty" } as unknown as Incoming], 0)).toEqual(INITIAL);
  });
});

it("reads frames and drops what is not one", () => {
  expect(parseFrame('[{"type":"pong","t":1},{"no":"type"},null,3]')).toEqual([{ type: "pong", t: 1 }]);
  expect(parseFrame("{broken")).toEqual([]);
  expect(parseFrame('{"type":"pong"}')).toEqual([]);
});

it("tries again after 0.3 s, doubling up to 2 s", () => {
  expect([0, 1, 2, 3, 9].map(retryDelay)).toEqual([300, 600, 1200, 2000, 2000]);
});
