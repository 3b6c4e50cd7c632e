import { expect, test } from "vitest";
import { KINDS, marksOf, together } from "../src/scene/featureShapes";

const features = { stamp_ns: 5e9, width: 640, height: 480, both_eyes: [], one_eye: [], rejected: [] };

test("each kind of feature has a shape and a sign of its own", () => {
  expect(new Set(KINDS.map(({ kind }) => marksOf(kind, [[0, 0]]))).size).toBe(3);
  expect(new Set(KINDS.map(({ sign }) => sign)).size).toBe(3);
});

test("a mark stands at its feature", () => {
  expect(marksOf("rejected", [[10, 20], [3, 4]]).match(/M[\d.,]+/g)).toEqual(["M10,20", "M3,4"]);
});

test("features of another picture are not drawn over this one", () => {
  expect([5e9, 5.3e9, 4.69e9, 5.4e9].map((stamp) => together(features, stamp))).toEqual([true, true, false, false]);
});
