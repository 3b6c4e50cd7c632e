/** The robot on the 2-D map. Sizes are in metres, but never too small to see. */
import type { RobotState } from "../protocol/messages";
import { type Point, type View, toScreen, yawOf } from "./projection";
import { type Context, type Ink, circle, positionOf, strokeWithHalo } from "./strokes";

/** Size of the drawn body, m. */
const BODY = { length: 0.56, width: 0.26 };

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
