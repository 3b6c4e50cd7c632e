/** Geometry of a mission: its length and where a new waypoint fits best. */
import type { Waypoint } from "../protocol/messages";

/** Length of the way from `start` (when known) through all waypoints, m. */
export function pathLength(waypoints: readonly Waypoint[], start: Waypoint | null): number {
  const points = start === null ? waypoints : [start, ...waypoints];
  let length = 0;
  points.forEach((point, k) => {
    const previous = points[k - 1];
    if (previous !== undefined) length += distance(previous, point);
  });
  return length;
}

export function distance(a: Waypoint, b: Waypoint): number {
  return Math.hypot(a.x - b.x, a.y - b.y);
}

/** Index at which inserting `point` lengthens the way least; the end when there is no segment yet. */
export function insertionIndex(waypoints: readonly Waypoint[], point: Waypoint): number {
  let best = waypoints.length;
  let least = Infinity;
  for (let k = 1; k < waypoints.length; k++) {
    const [before, after] = [waypoints[k - 1]!, waypoints[k]!];
    const detour = distance(before, point) + distance(point, after) - distance(before, after);
    if (detour < least) [best, least] = [k, detour];
  }
  return best;
}

/** The point to insert after `index`: halfway to the next waypoint, or half a metre on after the last one. */
export function pointAfter(waypoints: readonly Waypoint[], index: number): Waypoint {
  const here = waypoints[index] ?? { x: 0, y: 0 };
  const next = waypoints[index + 1];
  if (next !== undefined) return { x: (here.x + next.x) / 2, y: (here.y + next.y) / 2 };
  const previous = waypoints[index - 1];
  const step = previous === undefined ? 0 : distance(previous, here);
  if (previous === undefined || step === 0) return { x: here.x + 0.5, y: here.y };
  return { x: here.x + (0.5 * (here.x - previous.x)) / step, y: here.y + (0.5 * (here.y - previous.y)) / step };
}
