/** What lies under everything on the 2-D map: hatched where nothing is known, and a grid in metres. */
import { type View, scaleBarLength, toScreen } from "./projection";
import type { Context, Ink } from "./strokes";

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
