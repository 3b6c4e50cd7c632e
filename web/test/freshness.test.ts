import { describe, expect, it } from "vitest";
import { freshness, limitsOf, spokenAge } from "../src/console/freshness";

const limits = { stale: 0.5, lost: 3 };

describe("a value", () => {
  it("is live, then stale, then lost as it ages", () => {
    const levels = [0, 499, 500, 2999, 3000].map((now) => freshness(0, now, limits, true).level);
    expect(levels).toEqual(["live", "live", "stale", "stale", "lost"]);
  });

  it("is never live while the console is unreachable", () => {
    expect(freshness(0, 10, limits, false).level).toBe("stale");
  });

  it("that never came has no age", () => {
    expect(freshness(undefined, 10, limits, true)).toEqual({ level: "never", age: NaN });
  });

  it("from the future is as good as new", () => {
    expect(freshness(100, 0, limits, true)).toEqual({ level: "live", age: 0 });
  });
});

it("knows the limits of each key, and terrain keeps its own age", () => {
  expect(limitsOf("tele/state").stale).toBe(0.5);
  expect(limitsOf("tele/health/walk").stale).toBe(3);
  expect(limitsOf("state/mode").stale).toBe(1);
  expect(limitsOf("tele/map/tile/1_-2").stale).toBe(Infinity);
});

it("speaks ages as people do", () => {
  expect([0.42, 12.3, 250].map(spokenAge)).toEqual(["0.4 s", "12 s", "4 min"]);
});
