/** Ground that is forbidden: a polygon by its corners. Pure. */
import { sameWaypoints } from "../mission/waypoints";
import type { Waypoint } from "../protocol/messages";

export type Area = readonly Waypoint[];

export function sameAreas(a: readonly Area[], b: readonly Area[]): boolean {
  return a.length === b.length && a.every((area, k) => sameWaypoints(area, b[k]!));
}
