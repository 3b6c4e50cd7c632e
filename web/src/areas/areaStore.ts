/** Drawing of forbidden areas; those that are drawn are part of the mission's draft and its history. */
import { create } from "zustand";
import { useDraft } from "../mission/draftStore";
import { rounded } from "../mission/waypoints";
import type { Waypoint } from "../protocol/messages";
import { type Area, sameAreas } from "./area";

interface AreaStore {
  /** Corners of the one being drawn; null while none is. */
  drawing: Area | null;
  /** The robot's areas when last heard of. */
  onRobot: readonly Area[];
}

const LEAST_CORNERS = 3;
const EMPTY: AreaStore = { drawing: null, onRobot: [] };

export const useAreas = create<AreaStore>(() => EMPTY);

export function startArea(): void {
  useAreas.setState({ drawing: [] });
}

/** Takes a corner if an area is being drawn. */
export function cornerAt(place: Waypoint): boolean {
  const { drawing } = useAreas.getState();
  if (drawing === null) return false;
  draw([...drawing, rounded(place)]);
  return true;
}

export function canFinish({ drawing }: AreaStore): boolean {
  return drawing !== null && drawing.length >= LEAST_CORNERS;
}

export function finishArea(): void {
  const state = useAreas.getState();
  if (state.drawing === null || !canFinish(state)) return;
  useAreas.setState({ drawing: null });
  useDraft.getState().dispatch({ type: "forbid", area: state.drawing });
}

/** Takes back the last corner; without any gives up drawing. */
export function undoCorner(): void {
  const { drawing } = useAreas.getState();
  if (drawing !== null) draw(drawing.length > 0 ? drawing.slice(0, -1) : null);
}

/** Takes over what the robot holds, unless there are changes of our own that it has not got. */
export function followAreas(onRobot: readonly Area[]): void {
  const { onRobot: before } = useAreas.getState();
  if (sameAreas(onRobot, before)) return;
  useAreas.setState({ onRobot });
  const { draft, dispatch } = useDraft.getState();
  if (sameAreas(draft.areas, before)) dispatch({ type: "adopt", areas: onRobot });
}

export function resetAreas(): void {
  useAreas.setState(EMPTY);
}

function draw(drawing: Area | null): void {
  useAreas.setState({ drawing });
  useDraft.getState().publish();
}
