import { describe, expect, it } from "vitest";
import { drawnOver, sampled, valueAt } from "../src/adaptation/curve";
import { alertsOf } from "../src/status/advice";
import { allowedShare } from "../src/teleop/latency";

describe("a polynomial", () => {
  const stiffness = { roughness: [2500, -4200, 3150, -1050], step_height: [], lower: 400, upper: 2500 };
  const height = { roughness: [0.05, 0.03], step_height: [0.06], lower: 0.05, upper: 0.14 };

  it("gives the paper's ends and stays within its bounds", () => {
    expect([0, 1].map((r) => valueAt(stiffness, r, 0))).toEqual([2500, 400]);
    expect(valueAt(height, 1, 1)).toBeCloseTo(0.14);
    expect(valueAt({ ...height, upper: 0.1 }, 1, 1)).toBe(0.1);
  });

  it("is drawn over what it depends on, from 0 to 1", () => {
    expect([drawnOver(stiffness), drawnOver(height)]).toEqual(["roughness", "step_height"]);
    const points = sampled(height, 0.5);
    expect([points[0]!.at, points.at(-1)!.at]).toEqual([0, 1]);
    expect(points.at(-1)!.value - points[0]!.value).toBeCloseTo(0.06);
  });
});

it("the speed falls as the link gets slower, and never to nothing", () => {
  expect([0.01, 0.15].map(allowedShare)).toEqual([1, 1]);
  expect(allowedShare(0.375)).toBeCloseTo(0.6);
  expect([0.6, 5, null, NaN].map(allowedShare)).toEqual([0.2, 0.2, 0.2, 0.2]);
});

describe("alerts", () => {
  const well = { reasons: [], temperature: 40, battery: 0.8, pace: 1, odometry: "good" };

  it("are none while all is well or nothing is known", () => {
    expect(alertsOf(well)).toEqual([]);
    expect(alertsOf({ reasons: [], temperature: null, battery: null, pace: null, odometry: "" })).toEqual([]);
  });

  it("say what to do", () => {
    const found = alertsOf({ reasons: ["tilted by 38 degrees"], temperature: 70, battery: 0.1, pace: 0.5, odometry: "lost" });
    expect(found.map(({ advice }) => advice.split(/[ ;:,]/)[0])).toEqual(["Drive", "Let", "Bring", "The", "Wait"]);
    expect(alertsOf({ ...well, reasons: ["something else"] })[0]!.advice).not.toBe("");
  });
});
