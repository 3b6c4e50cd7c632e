/** The mission being edited: waypoints and forbidden areas with one history. Pure; the robot has its own copy. */
import { type Area, sameAreas } from "../areas/area";
import type { Waypoint } from "../protocol/messages";
import { rounded, same, sameWaypoints } from "./waypoints";

/** What an edit changes and an undo brings back. */
interface Plan {
  readonly waypoints: readonly Waypoint[];
  readonly areas: readonly Area[];
}

export interface Draft extends Plan {
  readonly selected: number | null;
  readonly past: readonly Plan[];
  readonly future: readonly Plan[];
}

export type DraftAction =
  | { type: "add"; waypoint: Waypoint }
  | { type: "insert"; index: number; waypoint: Waypoint }
  | { type: "place"; index: number; waypoint: Waypoint }
  | { type: "delete"; index: number }
  | { type: "reorder"; from: number; to: number }
  | { type: "clear" }
  | { type: "forbid"; area: Area }
  | { type: "allow"; index: number }
  | { type: "adopt"; waypoints?: readonly Waypoint[]; areas?: readonly Area[] }
  | { type: "load"; waypoints: readonly Waypoint[]; areas: readonly Area[] }
  | { type: "select"; index: number | null }
  | { type: "undo" }
  | { type: "redo" };

export const EMPTY_DRAFT: Draft = { waypoints: [], areas: [], selected: null, past: [], future: [] };

const UNDO_DEPTH = 100;

export function reduceDraft(draft: Draft, action: DraftAction): Draft {
  const { waypoints, areas } = draft;
  switch (action.type) {
    case "add":
      return reduceDraft(draft, { type: "insert", index: waypoints.length, waypoint: action.waypoint });
    case "insert": {
      const index = clamp(action.index, 0, waypoints.length);
      return edited(draft, { waypoints: waypoints.toSpliced(index, 0, rounded(action.waypoint)) }, index);
    }
    case "place": {
      if (!has(draft, action.index)) return draft;
      const waypoint = rounded(action.waypoint);
      if (same(waypoint, waypoints[action.index])) return { ...draft, selected: action.index };
      return edited(draft, { waypoints: waypoints.with(action.index, waypoint) }, action.index);
    }
    case "delete":
      if (!has(draft, action.index)) return draft;
      return edited(
        draft,
        { waypoints: waypoints.toSpliced(action.index, 1) },
        neighbour(action.index, waypoints.length - 1),
      );
    case "reorder":
      return reorder(draft, action.from, action.to);
    case "clear":
      return waypoints.length === 0 ? draft : edited(draft, { waypoints: [] }, null);
    case "forbid":
      return edited(draft, { areas: [...areas, action.area.map(rounded)] }, draft.selected);
    case "allow":
      return areas[action.index] === undefined
        ? draft
        : edited(draft, { areas: areas.toSpliced(action.index, 1) }, draft.selected);
    case "load":
      return load(draft, { waypoints: action.waypoints.map(rounded), areas: action.areas });
    case "adopt":
      return adopt(draft, { waypoints: action.waypoints?.map(rounded) ?? waypoints, areas: action.areas ?? areas });
    case "select":
      return { ...draft, selected: action.index !== null && has(draft, action.index) ? action.index : null };
    case "undo":
      return undo(draft);
    case "redo":
      return redo(draft);
  }
}

function edited(draft: Draft, change: Partial<Plan>, selected: number | null): Draft {
  const { waypoints, areas } = draft;
  const past = [...draft.past, { waypoints, areas }].slice(-UNDO_DEPTH);
  return { waypoints, areas, ...change, selected, past, future: [] };
}

/** What comes before the first edit is not something to undo. */
function adopt(draft: Draft, plan: Plan): Draft {
  if (samePlan(draft, plan)) return draft;
  if (draft.past.length === 0) return { ...EMPTY_DRAFT, ...plan };
  return edited(draft, plan, sameWaypoints(draft.waypoints, plan.waypoints) ? draft.selected : null);
}

function load(draft: Draft, plan: Plan): Draft {
  return samePlan(draft, plan) ? draft : edited(draft, plan, null);
}

function samePlan(a: Plan, b: Plan): boolean {
  return sameWaypoints(a.waypoints, b.waypoints) && sameAreas(a.areas, b.areas);
}

function reorder(draft: Draft, from: number, to: number): Draft {
  const moved = draft.waypoints[from];
  if (moved === undefined || !has(draft, to) || from === to) return draft;
  return edited(draft, { waypoints: draft.waypoints.toSpliced(from, 1).toSpliced(to, 0, moved) }, to);
}

function undo(draft: Draft): Draft {
  const previous = draft.past.at(-1);
  if (previous === undefined) return draft;
  const { waypoints, areas } = draft;
  return { ...previous, selected: null, past: draft.past.slice(0, -1), future: [{ waypoints, areas }, ...draft.future] };
}

function redo(draft: Draft): Draft {
  const next = draft.future[0];
  if (next === undefined) return draft;
  const { waypoints, areas } = draft;
  return { ...next, selected: null, past: [...draft.past, { waypoints, areas }], future: draft.future.slice(1) };
}

function has(draft: Draft, index: number): boolean {
  return Number.isInteger(index) && index >= 0 && index < draft.waypoints.length;
}

function neighbour(index: number, length: number): number | null {
  return length === 0 ? null : Math.min(index, length - 1);
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}
