import { beforeEach, describe, expect, it } from "vitest";
import { canFinish, cornerAt, finishArea, followAreas, resetAreas, startArea, undoCorner, useAreas } from "../src/areas/areaStore";
import { useDraft } from "../src/mission/draftStore";
import { forbiddenReason, hitArea } from "../src/areas/geometry";

const at = (x: number, y: number) => ({ x, y });
const square = [at(2, -0.5), at(3, -0.5), at(3, 0.5), at(2, 0.5)];

// The same cases as the robot's own test (tests/robot/test_forbidden_areas.py): both must judge alike.
it.each([
  [at(0, 0), at(5, 0), 1],
  [at(0, 0), at(2.5, 0), 1],
  [at(0, 0), at(1.5, 0), null],
  [at(0, 0), at(1.9, 0), 1],
  [at(0, 1), at(5, 1), null],
  [at(0, 0.7), at(5, 0.7), 1],
  [at(2.5, 0), at(5, 0), null],
  [at(2.5, 0), at(2.6, 0), 1],
])("a way keeps clear of an area", (begin, end, number) => {
  expect(hitArea([square], begin, end, 0.3)).toBe(number);
});

it("a refused way is told with its waypoint and area", () => {
  const far = square.map(({ x, y }) => at(x + 50, y));
  expect(forbiddenReason(at(0, 0), [at(1, 0), at(4, 0)], [far, square], 0.3)).toBe(
    "the way to waypoint 2 leads into forbidden area 2",
  );
  expect(forbiddenReason(null, [at(1, 0), at(4, 0)], [square], 0.3)).toContain("waypoint 2");
  expect(forbiddenReason(at(0, 0), [at(1, 0), at(1, 3)], [square], 0.3)).toBeNull();
});

describe("drawing an area", () => {
  beforeEach(() => {
    resetAreas();
    useDraft.getState().reset();
  });
  const areas = () => useDraft.getState().draft.areas;

  it("takes corners only while it is drawn, and three at least", () => {
    expect(cornerAt(at(0, 0))).toBe(false);
    startArea();
    for (const corner of [at(0, 0), at(1, 0)]) expect(cornerAt(corner)).toBe(true);
    expect(canFinish(useAreas.getState())).toBe(false);
    cornerAt(at(1, 1));
    finishArea();
    expect(areas()).toEqual([[at(0, 0), at(1, 0), at(1, 1)]]);
    expect(useAreas.getState().drawing).toBeNull();
  });

  it("goes back corner by corner, and then gives up", () => {
    startArea();
    cornerAt(at(0, 0));
    undoCorner();
    expect(useAreas.getState().drawing).toEqual([]);
    undoCorner();
    expect(useAreas.getState().drawing).toBeNull();
  });

  it("follows the robot until there are changes of its own", () => {
    followAreas([square]);
    expect(areas()).toEqual([square]);
    startArea();
    for (const corner of [at(7, 0), at(8, 0), at(8, 1)]) cornerAt(corner);
    finishArea();
    followAreas([]);
    expect(areas()).toHaveLength(2);
  });
});
