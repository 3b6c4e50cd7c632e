import { describe, expect, it } from "vitest";
import { CRUISE_AXES, POSE_AXES, robotValue, shownValue } from "../src/body/axes";

describe("axes of body and cruise", () => {
  const axis = (name: string) => [...POSE_AXES, ...CRUISE_AXES].find((one) => one.name === name)!;

  it("shows metres as centimetres and radians as degrees", () => {
    expect(shownValue(axis("z"), 0.0234)).toBe(2.3);
    expect(shownValue(axis("roll"), Math.PI / 36)).toBe(5);
    expect(shownValue(axis("turn"), 0.5)).toBe(29);
  });

  it("shows no negative zero", () => {
    expect(Object.is(shownValue(axis("x"), -0.0001), 0)).toBe(true);
  });

  it("sends what is shown in the robot's unit", () => {
    expect(robotValue(axis("y"), -1.5)).toBeCloseTo(-0.015, 12);
    expect(robotValue(axis("pitch"), 90)).toBeCloseTo(Math.PI / 2, 12);
    expect(robotValue(axis("forward"), 0.12)).toBeCloseTo(0.12, 12);
  });
});
