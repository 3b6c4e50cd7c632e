import { expect, it } from "vitest";
import { insertionIndex, pathLength, pointAfter } from "../src/mission/path";

const square = [
  { x: 0, y: 0 },
  { x: 2, y: 0 },
  { x: 2, y: 2 },
];

it("measures from the robot when it is known", () => {
  expect(pathLength(square, null)).toBeCloseTo(4);
  expect(pathLength(square, { x: -1, y: 0 })).toBeCloseTo(5);
  expect(pathLength([], { x: 1, y: 1 })).toBe(0);
});

it("inserts into the leg that is nearest", () => {
  expect(insertionIndex(square, { x: 1, y: 0.1 })).toBe(1);
  expect(insertionIndex(square, { x: 2.1, y: 1 })).toBe(2);
  expect(insertionIndex([square[0]!], { x: 5, y: 5 })).toBe(1);
});

it("offers the middle of the next leg, or half a metre on", () => {
  expect(pointAfter(square, 0)).toEqual({ x: 1, y: 0 });
  expect(pointAfter(square, 2)).toEqual({ x: 2, y: 2.5 });
  expect(pointAfter([{ x: 1, y: 1 }], 0)).toEqual({ x: 1.5, y: 1 });
});
