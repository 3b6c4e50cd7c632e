/** What is drawn over the terrain on the 2-D map. All positions are in world; sizes of symbols are in pixels. */
import type { RobotState, Waypoint } from "../protocol/messages";
import { type Point, type View, scaleBarLength, toScreen, yawOf } from "./projection";

export interface Ink {
  ground: string;
  hatch: string;
  grid: string;
  text: string;
  halo: string;
  path: string;
  trail: string;
  robot: string;
  truth: string;
}

/** Distance at which the robot turns to the next waypoint, and at which the last one is reached, m (ICRA'17 III-B). */
const ACCEPTANCE_RADIUS = 0.5;
const GOAL_RADIUS = 0.1;
/** Size of the drawn body, m. */
const BODY = { length: 0.56, width: 0.26 };
const WAYPOINT_PIXELS = 11;

type Context = CanvasRenderingContext2D;

export function drawUnknownGround(context: Context, view: View, ink: Ink): void {
  context.fillStyle = ink.ground;
  context.fillRect(0, 0, view.width, view.height);
  context.strokeStyle = ink.hatch;
  context.lineWidth = 1;
  context.beginPath();
  for (let x = -view.height; x < view.width; x += 12) {
    context.moveTo(x, view.height);
    context.lineTo(x + view.height, 0);
  }
  context.stroke();
}

export function drawGrid(context: Context, view: View, ink: Ink): void {
  const step = scaleBarLength(view.scale, 120);
  const [left, top] = [view.x - view.width / 2 / view.scale, view.y + view.height / 2 / view.scale];
  context.strokeStyle = ink.grid;
  context.lineWidth = 1;
  context.beginPath();
  for (let x = Math.ceil(left / step) * step; x < left + view.width / view.scale; x += step) {
    const at = Math.round(toScreen(view, { x, y: 0 }).x) + 0.5;
    context.moveTo(at, 0);
    context.lineTo(at, view.height);
  }
  for (let y = Math.floor(top / step) * step; y > top - view.height / view.scale; y -= step) {
    const at = Math.round(toScreen(view, { x: 0, y }).y) + 0.5;
    context.moveTo(0, at);
    context.lineTo(view.width, at);
  }
  context.stroke();
}

export function drawTrail(context: Context, view: View, trail: readonly Point[], ink: Ink): void {
  polyline(context, view, trail);
  strokeWithHalo(context, ink, ink.trail, 2);
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

export interface WaypointMark {
  waypoint: Waypoint;
  number: number;
  selected: boolean;
  reached: boolean;
  last: boolean;
}

export function drawWaypoint(context: Context, view: View, mark: WaypointMark, ink: Ink): void {
  const { x, y } = toScreen(view, mark.waypoint);
  circle(context, x, y, (mark.last ? GOAL_RADIUS : ACCEPTANCE_RADIUS) * view.scale);
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

/** Body with its heading, feet filled in stance and hollow in swing. `faded`: the state is old. */
export function drawRobot(context: Context, view: View, state: RobotState, faded: boolean, ink: Ink): void {
  const at = positionOf(state.position_in_world);
  const wxyz = state.wxyz;
  if (at === null || wxyz.length !== 4 || wxyz.some((part) => part === null)) return;
  context.save();
  context.globalAlpha = faded ? 0.45 : 1;
  const centre = toScreen(view, at);
  context.translate(centre.x, centre.y);
  context.rotate(-yawOf(wxyz as [number, number, number, number]));
  body(context, view.scale, ink);
  feet(context, view.scale, state, ink);
  context.restore();
}

export function drawTruth(context: Context, view: View, position: Point, ink: Ink): void {
  const { x, y } = toScreen(view, position);
  context.beginPath();
  context.moveTo(x - 8, y);
  context.lineTo(x + 8, y);
  context.moveTo(x, y - 8);
  context.lineTo(x, y + 8);
  strokeWithHalo(context, ink, ink.truth, 2);
}

export function positionOf(position: readonly (number | null)[]): Point | null {
  const [x, y] = position;
  return typeof x === "number" && typeof y === "number" ? { x, y } : null;
}

function body(context: Context, scale: number, ink: Ink): void {
  const [length, width] = [Math.max(BODY.length * scale, 18), Math.max(BODY.width * scale, 9)];
  context.beginPath();
  context.moveTo(length / 2 + width / 2, 0);
  context.lineTo(length / 2, width / 2);
  context.lineTo(-length / 2, width / 2);
  context.lineTo(-length / 2, -width / 2);
  context.lineTo(length / 2, -width / 2);
  context.closePath();
  context.fillStyle = ink.robot;
  context.fill();
  context.strokeStyle = ink.halo;
  context.lineWidth = 2;
  context.stroke();
}

function feet(context: Context, scale: number, state: RobotState, ink: Ink): void {
  state.foot_in_body.forEach((foot, leg) => {
    const [x, y] = foot;
    if (typeof x !== "number" || typeof y !== "number") return;
    circle(context, x * scale, -y * scale, Math.max(0.02 * scale, 2.5));
    context.fillStyle = state.foot_contact[leg] === true ? ink.robot : ink.halo;
    context.fill();
    context.strokeStyle = ink.robot;
    context.lineWidth = 1.5;
    context.stroke();
  });
}

function polyline(context: Context, view: View, points: readonly Point[]): void {
  context.beginPath();
  points.forEach((point, k) => {
    const { x, y } = toScreen(view, point);
    if (k === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  });
}

function circle(context: Context, x: number, y: number, radius: number): void {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
}

/** A line that stays visible on any ground: a halo under it. */
function strokeWithHalo(context: Context, ink: Ink, colour: string, width: number): void {
  context.lineJoin = "round";
  context.strokeStyle = ink.halo;
  context.lineWidth = width + 2;
  context.stroke();
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke();
}
