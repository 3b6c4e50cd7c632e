/** Whether a way comes into forbidden ground, as the robot judges it (robot_agent/navigation/keep_out.py). Pure. */
import type { Waypoint } from "../protocol/messages";
import type { Area } from "./area";

/** Why the way from `start` through the waypoints is refused; null when it is not. `halfWidth` in m. */
export function forbiddenReason(
  start: Waypoint | null,
  waypoints: readonly Waypoint[],
  areas: readonly Area[],
  halfWidth: number,
): string | null {
  const places = start === null ? waypoints : [start, ...waypoints];
  const first = start === null ? 1 : 0;
  for (let k = 1; k < places.length; k++) {
    const area = hitArea(areas, places[k - 1]!, places[k]!, halfWidth);
    if (area !== null) return `the way to waypoint ${k + first} leads into forbidden area ${area}`;
  }
  return null;
}

/** Number, from 1, of the first area that a strip about a straight leg comes into. */
export function hitArea(areas: readonly Area[], begin: Waypoint, end: Waypoint, halfWidth: number): number | null {
  for (const [index, area] of areas.entries()) {
    // A robot that stands in an area already may leave it.
    const start = distanceTo(area, begin, begin) < halfWidth ? end : begin;
    if (distanceTo(area, start, end) < halfWidth) return index + 1;
  }
  return null;
}

function distanceTo(area: Area, begin: Waypoint, end: Waypoint): number {
  let least = isInside(area, begin) ? 0 : Infinity;
  area.forEach((corner, k) => {
    const next = area[(k + 1) % area.length]!;
    if (crosses(corner, next, begin, end)) least = 0;
    least = Math.min(
      least,
      toSegment(begin, corner, next),
      toSegment(end, corner, next),
      toSegment(corner, begin, end),
    );
  });
  return least;
}

export function isInside(area: Area, { x, y }: Waypoint): boolean {
  let inside = false;
  area.forEach((a, k) => {
    const b = area[(k + 1) % area.length]!;
    if (a.y > y !== b.y > y && a.x + ((y - a.y) / (b.y - a.y)) * (b.x - a.x) > x) inside = !inside;
  });
  return inside;
}

function crosses(a: Waypoint, b: Waypoint, c: Waypoint, d: Waypoint): boolean {
  return side(c, d, a) * side(c, d, b) < 0 && side(a, b, c) * side(a, b, d) < 0;
}

function side(begin: Waypoint, end: Waypoint, place: Waypoint): number {
  return (end.x - begin.x) * (place.y - begin.y) - (end.y - begin.y) * (place.x - begin.x);
}

function toSegment(place: Waypoint, begin: Waypoint, end: Waypoint): number {
  const [dx, dy] = [end.x - begin.x, end.y - begin.y];
  const length = Math.max(dx * dx + dy * dy, 1e-12);
  const share = Math.min(Math.max(((place.x - begin.x) * dx + (place.y - begin.y) * dy) / length, 0), 1);
  return Math.hypot(place.x - begin.x - share * dx, place.y - begin.y - share * dy);
}
