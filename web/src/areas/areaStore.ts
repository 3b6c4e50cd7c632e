/** Forbidden areas as the operator draws them; the robot's own copy lives in state/areas. */
import { create } from "zustand";
import { sameWaypoints } from "../mission/draft";
import { useDraft } from "../mission/draftStore";
import type { Waypoint } from "../protocol/messages";
import type { Area } from "./geometry";

interface AreaStore {
  areas: readonly Area[];
  /** Corners of the one being drawn; null while none is. */
  drawing: Area | null;
  /** The robot's areas when last heard of. */
  onRobot: readonly Area[];
}

const LEAST_CORNERS = 3;
const EMPTY: AreaStore = { areas: [], drawing: null, onRobot: [] };

export const useAreas = create<AreaStore>(() => EMPTY);

export function startArea(): void {
  useAreas.setState({ drawing: [] });
}

/** Takes a corner if an area is being drawn. */
export function cornerAt({ x, y }: Waypoint): boolean {
  const { drawing } = useAreas.getState();
  if (drawing === null) return false;
  change({ drawing: [...drawing, { x: round(x), y: round(y) }] });
  return true;
}

export function canFinish({ drawing }: AreaStore): boolean {
  return drawing !== null && drawing.length >= LEAST_CORNERS;
}

export function finishArea(): void {
  const state = useAreas.getState();
  if (state.drawing !== null && canFinish(state)) change({ areas: [...state.areas, state.drawing], drawing: null });
}

/** Takes back the last corner; without any gives up drawing. */
export function undoCorner(): void {
  const { drawing } = useAreas.getState();
  if (drawing !== null) change({ drawing: drawing.length > 0 ? drawing.slice(0, -1) : null });
}

export function deleteArea(index: number): void {
  change({ areas: useAreas.getState().areas.toSpliced(index, 1) });
}

export function loadAreas(areas: readonly Area[]): void {
  change({ areas, drawing: null });
}

/** Takes over what the robot holds, unless there are changes of our own that it has not got. */
export function followAreas(onRobot: readonly Area[]): void {
  const { areas, onRobot: before } = useAreas.getState();
  if (sameAreas(onRobot, before)) return;
  change(sameAreas(areas, before) ? { onRobot, areas: onRobot } : { onRobot });
}

export function resetAreas(): void {
  useAreas.setState(EMPTY);
}

export function sameAreas(a: readonly Area[], b: readonly Area[]): boolean {
  return a.length === b.length && a.every((area, k) => sameWaypoints(area, b[k]!));
}

function change(changed: Partial<AreaStore>): void {
  useAreas.setState(changed);
  useDraft.getState().publish();
}

function round(value: number): number {
  return Math.round(1000 * value) / 1000;
}
