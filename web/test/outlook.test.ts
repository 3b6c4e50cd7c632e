import { describe, expect, it } from "vitest";
import { basis, estimate, spokenDuration } from "../src/mission/outlook";
import type { MissionOutlook } from "../src/protocol/messages";

const measured: MissionOutlook = {
  stamp_ns: 0,
  start_in_world: [0, 0],
  speed: 0.1,
  speed_basis: "measured",
  measured_over: 2.5,
  energy_per_metre: 900,
  cost_of_transport: 8.9,
};
const fresh: MissionOutlook = {
  ...measured,
  speed_basis: "gait",
  measured_over: 0,
  energy_per_metre: null,
  cost_of_transport: null,
};

describe("what a mission will take", () => {
  it("is length over speed, and length times energy per metre", () => {
    expect(estimate(12, measured)).toEqual({ seconds: 120, joules: 10800 });
  });

  it("leaves unknown what is not known", () => {
    expect(estimate(12, fresh)).toEqual({ seconds: 120, joules: NaN });
    expect(estimate(12, undefined)).toEqual({ seconds: NaN, joules: NaN });
    expect(estimate(null, measured)).toEqual({ seconds: NaN, joules: NaN });
    expect(estimate(12, { ...measured, speed: 0 }).seconds).toBeNaN();
  });

  it("says what it rests on", () => {
    expect(basis(measured)).toContain("0.10 m/s, 900 J/m (cost of transport 8.9), measured over the last 2.5 m");
    expect(basis(fresh)).toContain("The least time, at 0.10 m/s");
    expect(basis(undefined)).toBe("");
  });

  it("is spoken in minutes and seconds", () => {
    expect(spokenDuration(125.4)).toBe("2:05");
    expect(spokenDuration(59.7)).toBe("1:00");
  });
});
