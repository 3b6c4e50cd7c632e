/** The mission being edited: an undoable list of waypoints. Pure; the robot's own copy lives in MissionState. */
import type { Waypoint } from "../protocol/messages";

export interface Draft {
  readonly waypoints: readonly Waypoint[];
  readonly selected: number | null;
  readonly past: readonly (readonly Waypoint[])[];
  readonly future: readonly (readonly Waypoint[])[];
}

export type DraftAction =
  | { type: "add"; waypoint: Waypoint }
  | { type: "insert"; index: number; waypoint: Waypoint }
  | { type: "place"; index: number; waypoint: Waypoint }
  | { type: "delete"; index: number }
  | { type: "reorder"; from: number; to: number }
  | { type: "clear" }
  | { type: "adopt"; waypoints: readonly Waypoint[] }
  | { type: "load"; waypoints: readonly Waypoint[] }
  | { type: "select"; index: number | null }
  | { type: "undo" }
  | { type: "redo" };

export const EMPTY_DRAFT: Draft = { waypoints: [], selected: null, past: [], future: [] };

const UNDO_DEPTH = 100;
/** Coordinates are kept to a millimetre, so that a value shown is the value sent. */
const GRID = 1000;

export function reduceDraft(draft: Draft, action: DraftAction): Draft {
  const { waypoints } = draft;
  switch (action.type) {
    case "add":
      return reduceDraft(draft, { type: "insert", index: waypoints.length, waypoint: action.waypoint });
    case "insert": {
      const index = clamp(action.index, 0, waypoints.length);
      return edited(draft, waypoints.toSpliced(index, 0, rounded(action.waypoint)), index);
    }
    case "place": {
      if (!has(draft, action.index)) return draft;
      const waypoint = rounded(action.waypoint);
      if (same(waypoint, waypoints[action.index])) return { ...draft, selected: action.index };
      return edited(draft, waypoints.with(action.index, waypoint), action.index);
    }
    case "delete":
      if (!has(draft, action.index)) return draft;
      return edited(draft, waypoints.toSpliced(action.index, 1), neighbour(action.index, waypoints.length - 1));
    case "reorder":
      return reorder(draft, action.from, action.to);
    case "clear":
      return waypoints.length === 0 ? draft : edited(draft, [], null);
    case "load":
      return sameWaypoints(waypoints, action.waypoints) ? draft : edited(draft, action.waypoints.map(rounded), null);
    case "adopt":
      return adopt(draft, action.waypoints.map(rounded));
    case "select":
      return { ...draft, selected: action.index !== null && has(draft, action.index) ? action.index : null };
    case "undo":
      return undo(draft);
    case "redo":
      return redo(draft);
  }
}

/** Whether the robot holds exactly these waypoints. */
export function sameWaypoints(a: readonly Waypoint[], b: readonly Waypoint[]): boolean {
  return a.length === b.length && a.every((waypoint, k) => same(waypoint, b[k]));
}

function edited(draft: Draft, waypoints: readonly Waypoint[], selected: number | null): Draft {
  return { waypoints, selected, past: [...draft.past, draft.waypoints].slice(-UNDO_DEPTH), future: [] };
}

/** What comes before the first edit is not something to undo. */
function adopt(draft: Draft, waypoints: readonly Waypoint[]): Draft {
  if (sameWaypoints(draft.waypoints, waypoints)) return draft;
  return draft.past.length === 0 ? { ...EMPTY_DRAFT, waypoints } : edited(draft, waypoints, null);
}

function reorder(draft: Draft, from: number, to: number): Draft {
  const moved = draft.waypoints[from];
  if (moved === undefined || !has(draft, to) || from === to) return draft;
  return edited(draft, draft.waypoints.toSpliced(from, 1).toSpliced(to, 0, moved), to);
}

function undo(draft: Draft): Draft {
  const previous = draft.past.at(-1);
  if (previous === undefined) return draft;
  return {
    waypoints: previous,
    selected: null,
    past: draft.past.slice(0, -1),
    future: [draft.waypoints, ...draft.future],
  };
}

function redo(draft: Draft): Draft {
  const next = draft.future[0];
  if (next === undefined) return draft;
  return { waypoints: next, selected: null, past: [...draft.past, draft.waypoints], future: draft.future.slice(1) };
}

function has(draft: Draft, index: number): boolean {
  return Number.isInteger(index) && index >= 0 && index < draft.waypoints.length;
}

function neighbour(index: number, length: number): number | null {
  return length === 0 ? null : Math.min(index, length - 1);
}

function rounded({ x, y }: Waypoint): Waypoint {
  return { x: Math.round(x * GRID) / GRID, y: Math.round(y * GRID) / GRID };
}

function same(a: Waypoint, b: Waypoint | undefined): boolean {
  return b !== undefined && Math.abs(a.x - b.x) < 0.5 / GRID && Math.abs(a.y - b.y) < 0.5 / GRID;
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}
