import { expect, test } from "vitest";
import { heatOf } from "../src/robot/heat";

test("a servo is warm from 65 degrees and hot from 75", () => {
  expect([64.9, 65, 74.9, 75].map(heatOf)).toEqual([null, "warm", "warm", "hot"]);
});

test("what was not measured is neither", () => {
  expect([null, undefined, Number.NaN].map(heatOf)).toEqual([null, null, null]);
});
