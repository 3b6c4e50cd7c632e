import { expect, test } from "vitest";
import { STEP_COUNT, USUAL, faultOf, stepsDone, wordsOf } from "../src/calibration/target";

test("a target is told in metres, and from where its pictures come", () => {
  expect(wordsOf(USUAL, "")).toBe("aprilgrid 6 6 0.088 0.3");
  expect(wordsOf({ ...USUAL, kind: "checkerboard", columns: 9, rows: 7, size: 25 }, "a.mcap")).toBe(
    "checkerboard 9 7 0.025 from a.mcap",
  );
});

test("a target that can not be is named before it is sent", () => {
  expect(faultOf(USUAL)).toBeNull();
  expect(faultOf({ ...USUAL, columns: NaN })).toContain("whole numbers");
  expect(faultOf({ ...USUAL, columns: 30, rows: 30 })).toContain("whole numbers");
  expect(faultOf({ ...USUAL, kind: "checkerboard", rows: 2 })).toContain("from 3 up");
  expect(faultOf({ ...USUAL, size: 0 })).toContain("1 to 10000 mm");
  expect(faultOf({ ...USUAL, spacing: 2 })).toContain("0.05 to 1");
  expect(faultOf({ ...USUAL, kind: "checkerboard", spacing: NaN })).toBeNull();
});

test("solving advances step by step", () => {
  expect(["", "lens of the left eye", "lens of the right eye", "both eyes together"].map(stepsDone)).toEqual([
    0, 0, 1, 2,
  ]);
  expect(STEP_COUNT).toBe(3);
});
