import { describe, expect, it } from "vitest";
import { INITIAL } from "../src/console/store";
import { freshnessOf } from "../src/console/useLatest";
import { landing, lastMark, neighbourMark, replayIdOf } from "../src/replay/timeline";

const marks = [2, 5, 5.1, 60].map((seconds) => ({ seconds, severity: "info" as const, source: "robot", text: "" }));

describe("a timeline", () => {
  it("lands a little before an event", () => {
    expect(marks.map(landing)).toEqual([1, 4, 4.1, 59]);
    expect(landing({ seconds: 0.4 })).toBe(0);
  });

  it("goes from event to event, and not to the one it stands at", () => {
    expect(neighbourMark(marks, 0, 1)?.seconds).toBe(2);
    expect(neighbourMark(marks, 1, 1)?.seconds).toBe(5);
    expect(neighbourMark(marks, 4, 1)?.seconds).toBe(60);
    expect(neighbourMark(marks, 59, 1)).toBeUndefined();
    expect(neighbourMark(marks, 59, -1)?.seconds).toBe(5.1);
    expect(neighbourMark(marks, 1, -1)).toBeUndefined();
  });

  it("knows what had happened last", () => {
    expect([1, 2, 5.1, 100].map((seconds) => lastMark(marks, seconds))).toEqual([-1, 0, 2, 3]);
  });
});

it("a recording is replayed under the name that the recorder gives it", () => {
  expect(replayIdOf("sim-1_2026-01-02_03-04-05.mcap")).toBe("replay-sim-1_2026-01-02_03-04-05");
  expect(replayIdOf("a.b c.mcap")).toBe("replay-a_b_c");
});

describe("in a replay", () => {
  const at = (stamp: number, received: number) => ({ value: { stamp_ns: stamp * 1e9 }, received });
  const state = {
    ...INITIAL,
    connection: "open" as const,
    now: 100_000,
    values: { "state/replay": at(50, 99_950), "tele/state": at(49.8, 10_000), "tele/gait": at(48, 10_000) },
  };

  it("a pause makes nothing old, and a gap that was recorded is seen", () => {
    expect(freshnessOf(state, "tele/state").level).toBe("live");
    expect(freshnessOf(state, "tele/gait")).toEqual({ level: "stale", age: 2 });
    expect(freshnessOf(state, "tele/power").level).toBe("never");
  });

  it("everything is old when the replay itself falls silent", () => {
    expect(freshnessOf({ ...state, now: 103_000 }, "tele/state").level).toBe("stale");
  });
});
