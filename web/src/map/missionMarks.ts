/** The mission on the 2-D map: the way walked, the way to go, the waypoints and the follower's target. */
import type { Waypoint } from "../protocol/messages";
import type { TrailPoint } from "../console/history";
import { TRANSPORT, colourOf } from "./colourScale";
import { type Point, type View, toScreen } from "./projection";
import { type Context, type Ink, circle, polyline, strokeWithHalo } from "./strokes";

const WAYPOINT_PIXELS = 11;

/** The way walked, in the colours of what it cost; as ink where that is not known. */
export function drawTrail(context: Context, view: View, trail: readonly TrailPoint[], ink: Ink): void {
  polyline(context, view, trail);
  strokeWithHalo(context, ink, ink.trail, 2);
  context.lineWidth = 3;
  for (let k = 1; k < trail.length; k++) {
    const cost = trail[k]!.cost;
    if (cost === null) continue;
    const [red, green, blue] = colourOf(TRANSPORT, cost);
    context.strokeStyle = `rgb(${red}, ${green}, ${blue})`;
    polyline(context, view, [trail[k - 1]!, trail[k]!]);
    context.stroke();
  }
}

/** The way still to go: from the robot (when known) through the waypoints. */
export function drawPath(
  context: Context,
  view: View,
  robot: Point | null,
  waypoints: readonly Waypoint[],
  ink: Ink,
): void {
  if (waypoints.length === 0) return;
  context.setLineDash([7, 5]);
  polyline(context, view, robot === null ? waypoints : [robot, ...waypoints]);
  strokeWithHalo(context, ink, ink.path, 2);
  context.setLineDash([]);
}

/** The strip in which the feet are expected. */
export function drawCorridor(
  context: Context,
  view: View,
  robot: Point | null,
  waypoints: readonly Waypoint[],
  halfWidth: number,
  ink: Ink,
): void {
  if (waypoints.length === 0 || halfWidth <= 0) return;
  context.globalAlpha = 0.18;
  context.strokeStyle = ink.path;
  context.lineWidth = 2 * halfWidth * view.scale;
  context.lineJoin = "round";
  polyline(context, view, robot === null ? waypoints : [robot, ...waypoints]);
  context.stroke();
  context.globalAlpha = 1;
}

export interface WaypointMark {
  waypoint: Waypoint;
  number: number;
  selected: boolean;
  reached: boolean;
  /** Distance at which it counts as passed or reached, m. */
  radius: number;
}

export function drawWaypoint(context: Context, view: View, mark: WaypointMark, ink: Ink): void {
  const { x, y } = toScreen(view, mark.waypoint);
  circle(context, x, y, mark.radius * view.scale);
  context.setLineDash([3, 3]);
  strokeWithHalo(context, ink, ink.path, 1);
  context.setLineDash([]);
  circle(context, x, y, mark.selected ? WAYPOINT_PIXELS + 3 : WAYPOINT_PIXELS);
  context.fillStyle = mark.reached ? ink.halo : ink.path;
  context.fill();
  strokeWithHalo(context, ink, mark.selected ? ink.text : ink.path, mark.selected ? 3 : 1.5);
  context.fillStyle = mark.reached ? ink.path : ink.halo;
  context.font = "600 12px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText(mark.reached ? "✓" : String(mark.number), x, y + 0.5);
}

export function drawLookahead(context: Context, view: View, robot: Point, lookahead: Point, ink: Ink): void {
  polyline(context, view, [robot, lookahead]);
  strokeWithHalo(context, ink, ink.robot, 1.5);
  const at = toScreen(view, lookahead);
  circle(context, at.x, at.y, 4);
  context.fillStyle = ink.robot;
  context.fill();
}
