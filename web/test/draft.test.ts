import { describe, expect, it } from "vitest";
import { type Draft, type DraftAction, EMPTY_DRAFT, reduceDraft } from "../src/mission/draft";
import { sameWaypoints } from "../src/mission/waypoints";

const at = (x: number, y = 0) => ({ x, y });
const after = (...actions: DraftAction[]) => actions.reduce(reduceDraft, EMPTY_DRAFT);
const xs = (draft: Draft) => draft.waypoints.map((waypoint) => waypoint.x);
const pit = [at(0, 1), at(1, 1), at(1, 2)];
const three: DraftAction[] = [1, 2, 3].map((x) => ({ type: "add", waypoint: at(x) }));

describe("a mission draft", () => {
  it("keeps waypoints in the order in which they were added", () => {
    expect(xs(after(...three))).toEqual([1, 2, 3]);
  });

  it("selects what was just edited, and the neighbour of what was deleted", () => {
    expect(after(...three).selected).toBe(2);
    expect(after(...three, { type: "delete", index: 0 }).selected).toBe(0);
    expect(after(...three, { type: "delete", index: 2 }).selected).toBe(1);
    expect(after(three[0]!, { type: "delete", index: 0 }).selected).toBeNull();
  });

  it("inserts, places, deletes and reorders", () => {
    expect(xs(after(...three, { type: "insert", index: 1, waypoint: at(9) }))).toEqual([1, 9, 2, 3]);
    expect(xs(after(...three, { type: "place", index: 1, waypoint: at(9) }))).toEqual([1, 9, 3]);
    expect(xs(after(...three, { type: "delete", index: 1 }))).toEqual([1, 3]);
    expect(xs(after(...three, { type: "reorder", from: 0, to: 2 }))).toEqual([2, 3, 1]);
  });

  it("can take a loaded mission back", () => {
    const loaded = after(...three, { type: "load", waypoints: [at(7.0004)], areas: [pit] });
    expect(xs(loaded)).toEqual([7]);
    expect(loaded.areas).toEqual([pit]);
    const before = reduceDraft(loaded, { type: "undo" });
    expect(xs(before)).toEqual([1, 2, 3]);
    expect(before.areas).toEqual([]);
    expect(reduceDraft(loaded, { type: "load", waypoints: [at(7)], areas: [pit] })).toBe(loaded);
  });

  it("ignores places that do not exist", () => {
    const draft = after(...three);
    for (const action of [
      { type: "delete", index: 3 },
      { type: "delete", index: -1 },
      { type: "place", index: 7, waypoint: at(0) },
      { type: "reorder", from: 0, to: 3 },
      { type: "reorder", from: 0, to: 0 },
    ] as DraftAction[]) {
      expect(reduceDraft(draft, action)).toBe(draft);
    }
  });

  it("undoes every edit back to nothing, and redoes them to the same list", () => {
    const edits: DraftAction[] = [
      ...three,
      { type: "forbid", area: pit },
      { type: "reorder", from: 2, to: 0 },
      { type: "forbid", area: pit.map(({ x, y }) => at(x + 5, y)) },
      { type: "allow", index: 0 },
      { type: "delete", index: 1 },
      { type: "place", index: 0, waypoint: at(4.5) },
      { type: "clear" },
    ];
    let draft = after(...edits);
    const end = draft;
    for (const _ of edits) draft = reduceDraft(draft, { type: "undo" });
    expect(draft.waypoints).toEqual([]);
    expect(draft.areas).toEqual([]);
    expect(draft.past).toEqual([]);
    for (const _ of edits) draft = reduceDraft(draft, { type: "redo" });
    expect([draft.waypoints, draft.areas]).toEqual([end.waypoints, end.areas]);
    expect(end.areas).toHaveLength(1);
    expect(draft.future).toEqual([]);
  });

  it("brings a deleted area back, and leaves waypoints placed since alone", () => {
    const forbidden = after({ type: "forbid", area: pit }, three[0]!, { type: "allow", index: 0 });
    expect(forbidden.areas).toEqual([]);
    const back = reduceDraft(forbidden, { type: "undo" });
    expect([back.areas, xs(back)]).toEqual([[pit], [1]]);
    expect(reduceDraft(back, { type: "allow", index: 1 })).toBe(back);
  });

  it("forgets what was undone once something else is done", () => {
    const draft = after(...three, { type: "undo" }, { type: "add", waypoint: at(8) });
    expect(xs(draft)).toEqual([1, 2, 8]);
    expect(reduceDraft(draft, { type: "redo" })).toBe(draft);
  });

  it("does not count selecting, or moving to the same place, as an edit", () => {
    const draft = after(...three, { type: "select", index: 1 }, { type: "place", index: 1, waypoint: at(2.0001) });
    expect(draft.past).toHaveLength(3);
  });

  it("keeps coordinates to a millimetre", () => {
    expect(after({ type: "add", waypoint: at(0.12345, -0.98765) }).waypoints).toEqual([{ x: 0.123, y: -0.988 }]);
  });

  it("adopts the robot's mission without an undo step at first, with one later", () => {
    expect(after({ type: "adopt", waypoints: [at(5)] }).past).toHaveLength(0);
    expect(after(...three, { type: "adopt", waypoints: [at(5)] }, { type: "undo" }).waypoints).toHaveLength(3);
  });

  it("tells what the robot has not got yet", () => {
    expect(sameWaypoints([at(1)], [at(1.0002)])).toBe(true);
    expect(sameWaypoints([at(1)], [at(1.01)])).toBe(false);
    expect(sameWaypoints([at(1)], [])).toBe(false);
  });
});
