import { expect, test } from "vitest";
import { found, ofParameter, ofPose, outside } from "../src/settings/settings";

const height = ofParameter(
  { name: "stride_height", label: "Stride height", unit: "m", digits: 3, step: 0.001, lower: 0.03, upper: 0.14 },
  0.06,
);
const all = [height, ...ofPose([0.02, 0, 0, 0.1, 0, 0], [0.05, 0.05, 0.05, 0.2, 0.2, 0.3])];

test("settings are found by the words of their names and units", () => {
  expect(found(all, "").length).toBe(7);
  expect(found(all, " HEIGHT stride").map(({ label }) => label)).toEqual(["Stride height"]);
  expect(found(all, "cm").length).toBe(3);
  expect(found(all, "nonsense")).toEqual([]);
});

test("a pose is shown and set in centimetres and degrees, and sent in metres and radians", () => {
  const [forward, , , roll] = all.slice(1);
  expect([forward!.value, forward!.lower, forward!.upper]).toEqual([2, -5, 5]);
  expect(forward!.fields(3)).toEqual({ name: "x", value: 0.03 });
  expect(roll!.fields(90).value).toBeCloseTo(Math.PI / 2);
});

test("what is outside the bounds is told with them", () => {
  expect(outside(height, 0.14)).toBeNull();
  expect(outside(height, 0.2)).toBe("it goes from 0.030 to 0.140 m");
});
