/** Does on the map what its keys mean. */
import type { KeyboardEvent } from "react";
import { cornerAt } from "../areas/areaStore";
import { measureAt } from "../measure/measureStore";
import { useDraft } from "../mission/draftStore";
import { insertionIndex } from "../mission/path";
import { mapKey } from "./keys";
import type { Point } from "./projection";
import type { MapView } from "./useMapView";

export function useMapKeys(map: MapView): (event: KeyboardEvent) => void {
  return (event) => {
    const { draft, dispatch } = useDraft.getState();
    const key = event.ctrlKey || event.metaKey || event.altKey ? null : mapKey(event, draft.selected !== null);
    if (key === null) return;
    event.preventDefault();
    const { scale } = map.view.current;
    const selected = draft.selected === null ? undefined : draft.waypoints[draft.selected];
    switch (key.type) {
      case "pan":
        return map.pan(-key.dx * scale, key.dy * scale);
      case "nudge":
        if (selected === undefined || draft.selected === null) return;
        return dispatch({
          type: "place",
          index: draft.selected,
          waypoint: { x: selected.x + key.dx, y: selected.y + key.dy },
        });
      case "zoom":
        return map.zoom(key.factor);
      case "add":
        return addWaypoint({ x: map.view.current.x, y: map.view.current.y }, event.shiftKey);
      case "delete":
        return draft.selected === null ? undefined : dispatch({ type: "delete", index: draft.selected });
      case "next":
      case "previous":
        return dispatch({
          type: "select",
          index: neighbour(draft.selected, draft.waypoints.length, key.type === "next" ? 1 : -1),
        });
      case "deselect":
        return dispatch({ type: "select", index: null });
      case "centre":
        return map.centre();
    }
  };
}

/** At the end, or in the leg that it lengthens least. */
export function addWaypoint(waypoint: Point, insert: boolean): void {
  if (measureAt(waypoint) || cornerAt(waypoint)) return;
  const { draft, dispatch } = useDraft.getState();
  if (insert) dispatch({ type: "insert", index: insertionIndex(draft.waypoints, waypoint), waypoint });
  else dispatch({ type: "add", waypoint });
}

function neighbour(selected: number | null, length: number, step: number): number | null {
  if (length === 0) return null;
  if (selected === null) return step > 0 ? 0 : length - 1;
  return (selected + step + length) % length;
}
