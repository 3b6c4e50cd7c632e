/** The one draft of this page, shared by list, map and 3-D view. Each change is shown in the 3-D view too. */
import { create } from "zustand";
import { sameAreas } from "../areas/area";
import { useAreas } from "../areas/areaStore";
import { shareAreas } from "../areas/sharing";
import { send } from "../console/outbox";
import type { Waypoint } from "../protocol/messages";
import { type Draft, type DraftAction, EMPTY_DRAFT, reduceDraft } from "./draft";
import { sameWaypoints } from "./waypoints";

const PUBLISH_PERIOD = 100; // ms, the console takes at most 10 a second

interface DraftStore {
  draft: Draft;
  /** A waypoint under way: drawn, but not yet an undo step. */
  dragging: { index: number; waypoint: Waypoint } | null;
  /** The robot's waypoints when last heard of. */
  onRobot: readonly Waypoint[];
  dispatch(action: DraftAction): void;
  drag(index: number, waypoint: Waypoint, done: boolean): void;
  /** Takes over what the robot holds, unless there are changes of our own that it has not got. */
  follow(onRobot: readonly Waypoint[]): void;
  reset(): void;
  publish(): void;
}

let timer: ReturnType<typeof setTimeout> | undefined;

export const useDraft = create<DraftStore>((set, get) => ({
  draft: EMPTY_DRAFT,
  dragging: null,
  onRobot: [],
  dispatch(action) {
    const { areas } = get().draft;
    set(({ draft }) => ({ draft: reduceDraft(draft, action), dragging: null }));
    get().publish();
    if (action.type !== "adopt" && !sameAreas(areas, get().draft.areas)) shareAreas();
  },
  drag(index, waypoint, done) {
    if (done) get().dispatch({ type: "place", index, waypoint });
    else {
      set({ dragging: { index, waypoint } });
      get().publish();
    }
  },
  follow(onRobot) {
    const { draft, onRobot: before, dispatch } = get();
    if (sameWaypoints(onRobot, before)) return;
    set({ onRobot });
    if (sameWaypoints(draft.waypoints, before)) dispatch({ type: "adopt", waypoints: onRobot });
  },
  reset() {
    set({ draft: EMPTY_DRAFT, dragging: null, onRobot: [] });
  },
  publish() {
    timer ??= setTimeout(() => {
      timer = undefined;
      const { drawing } = useAreas.getState();
      const { areas } = get().draft;
      const shown = drawing === null || drawing.length < 2 ? areas : [...areas, drawing];
      send({ type: "draft", waypoints: shownWaypoints(get()), selected: get().draft.selected, areas: shown });
    }, PUBLISH_PERIOD);
  },
}));

/** The waypoints as drawn: the draft with the one under way in its new place. */
export function shownWaypoints({ draft, dragging }: Pick<DraftStore, "draft" | "dragging">): readonly Waypoint[] {
  if (dragging === null || draft.waypoints[dragging.index] === undefined) return draft.waypoints;
  return draft.waypoints.with(dragging.index, dragging.waypoint);
}
