/** When places count as the same. Pure. */
import type { Waypoint } from "../protocol/messages";

/** Coordinates are kept to a millimetre, so that a value shown is the value sent. */
const GRID = 1000;

export function rounded({ x, y }: Waypoint): Waypoint {
  return { x: Math.round(x * GRID) / GRID, y: Math.round(y * GRID) / GRID };
}

export function same(a: Waypoint, b: Waypoint | undefined): boolean {
  return b !== undefined && Math.abs(a.x - b.x) < 0.5 / GRID && Math.abs(a.y - b.y) < 0.5 / GRID;
}

/** Whether the robot holds exactly these waypoints. */
export function sameWaypoints(a: readonly Waypoint[], b: readonly Waypoint[]): boolean {
  return a.length === b.length && a.every((waypoint, k) => same(waypoint, b[k]));
}
