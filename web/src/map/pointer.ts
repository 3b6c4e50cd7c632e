/** Mouse, pen and fingers on the map: click adds, drag moves a waypoint or the map, two fingers or the wheel zoom. */
import type { Point } from "./projection";

export interface MapActions {
  /** Index of the waypoint under a point of the screen, null for none. */
  waypointAt(screen: Point): number | null;
  add(screen: Point, insert: boolean): void;
  select(index: number): void;
  remove(index: number): void;
  drag(index: number, screen: Point, done: boolean): void;
  pan(dx: number, dy: number): void;
  zoom(screen: Point, factor: number): void;
}

/** Pixels a pointer may move and still be clicking. */
const SLACK = 5;
const ZOOM_PER_WHEEL_PIXEL = 0.0015;

interface Grip {
  start: Point;
  last: Point;
  waypoint: number | null;
  moved: boolean;
}

/** Listens on `canvas`; the returned function ends it. */
export function listenToPointer(canvas: HTMLCanvasElement, actions: MapActions): () => void {
  const fingers = new Map<number, Point>();
  let grip: Grip | null = null;

  const down = (event: PointerEvent) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    const at = pointOf(event);
    fingers.set(event.pointerId, at);
    grip = fingers.size > 1 ? null : { start: at, last: at, waypoint: actions.waypointAt(at), moved: false };
  };

  const move = (event: PointerEvent) => {
    const at = pointOf(event);
    if (!fingers.has(event.pointerId)) {
      canvas.style.cursor = actions.waypointAt(at) === null ? "crosshair" : "grab";
      return;
    }
    if (fingers.size === 2) pinch(fingers, event.pointerId, at, actions);
    fingers.set(event.pointerId, at);
    if (grip === null) return;
    grip.moved ||= Math.hypot(at.x - grip.start.x, at.y - grip.start.y) > SLACK;
    if (!grip.moved) return;
    if (grip.waypoint !== null) actions.drag(grip.waypoint, at, false);
    else actions.pan(at.x - grip.last.x, at.y - grip.last.y);
    grip.last = at;
  };

  const up = (event: PointerEvent) => {
    fingers.delete(event.pointerId);
    const done = grip;
    grip = null;
    if (done === null || event.type === "pointercancel") return;
    const at = pointOf(event);
    if (done.waypoint !== null && done.moved) actions.drag(done.waypoint, at, true);
    else if (done.waypoint !== null) actions.select(done.waypoint);
    else if (!done.moved) actions.add(at, event.shiftKey);
  };

  const wheel = (event: WheelEvent) => {
    event.preventDefault();
    actions.zoom(pointOf(event), Math.exp(-event.deltaY * ZOOM_PER_WHEEL_PIXEL));
  };

  const menu = (event: MouseEvent) => {
    event.preventDefault();
    const index = actions.waypointAt(pointOf(event));
    if (index !== null) actions.remove(index);
  };

  const abort = new AbortController();
  const { signal } = abort;
  canvas.addEventListener("pointerdown", down, { signal });
  canvas.addEventListener("pointermove", move, { signal });
  canvas.addEventListener("pointerup", up, { signal });
  canvas.addEventListener("pointercancel", up, { signal });
  canvas.addEventListener("wheel", wheel, { signal, passive: false });
  canvas.addEventListener("contextmenu", menu, { signal });
  return () => abort.abort();
}

function pinch(fingers: Map<number, Point>, id: number, at: Point, actions: MapActions): void {
  const before = fingers.get(id);
  const other = [...fingers].find(([finger]) => finger !== id)?.[1];
  if (before === undefined || other === undefined) return;
  const middle = { x: (at.x + other.x) / 2, y: (at.y + other.y) / 2 };
  const spread = Math.hypot(before.x - other.x, before.y - other.y);
  if (spread > 0) actions.zoom(middle, Math.hypot(at.x - other.x, at.y - other.y) / spread);
  actions.pan((at.x - before.x) / 2, (at.y - before.y) / 2);
}

function pointOf(event: { offsetX: number; offsetY: number }): Point {
  return { x: event.offsetX, y: event.offsetY };
}
