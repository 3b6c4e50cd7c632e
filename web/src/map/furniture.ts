/** Scale bar, axes and the keyboard's cross hair: what helps to read the map. */
import { type View, scaleBarLength } from "./projection";
import type { Ink } from "./strokes";

type Context = CanvasRenderingContext2D;

const MARGIN = 14;

export function drawScaleBar(context: Context, view: View, ink: Ink): void {
  const length = scaleBarLength(view.scale, 120);
  const pixels = length * view.scale;
  const y = view.height - MARGIN;
  plate(context, MARGIN - 6, y - 24, Math.max(pixels, 40) + 12, 32, ink);
  context.strokeStyle = ink.text;
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(MARGIN, y - 5);
  context.lineTo(MARGIN, y);
  context.lineTo(MARGIN + pixels, y);
  context.lineTo(MARGIN + pixels, y - 5);
  context.stroke();
  label(context, `${Number(length.toPrecision(1))} m`, MARGIN, y - 14, ink);
}

/** The world's axes: the map is never turned, so they always point this way. */
export function drawAxes(context: Context, view: View, ink: Ink): void {
  const [x, y] = [view.width - 54, view.height - MARGIN - 4];
  plate(context, x - 10, y - 42, 56, 50, ink);
  arrow(context, x, y, x + 26, y, ink);
  arrow(context, x, y, x, y - 26, ink);
  label(context, "x", x + 32, y, ink);
  label(context, "y", x - 3, y - 35, ink);
}

export function drawCrossHair(context: Context, view: View, ink: Ink): void {
  const [x, y] = [view.width / 2, view.height / 2];
  for (const [colour, width] of [
    [ink.halo, 4],
    [ink.text, 1.5],
  ] as const) {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    for (const [dx, dy] of [
      [1, 0],
      [-1, 0],
      [0, 1],
      [0, -1],
    ] as const) {
      context.moveTo(x + 5 * dx, y + 5 * dy);
      context.lineTo(x + 15 * dx, y + 15 * dy);
    }
    context.stroke();
  }
}

function arrow(context: Context, x0: number, y0: number, x1: number, y1: number, ink: Ink): void {
  const angle = Math.atan2(y1 - y0, x1 - x0);
  context.strokeStyle = ink.text;
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  for (const side of [-1, 1]) {
    context.moveTo(x1, y1);
    context.lineTo(x1 - 7 * Math.cos(angle + 0.45 * side), y1 - 7 * Math.sin(angle + 0.45 * side));
  }
  context.stroke();
}

function plate(context: Context, x: number, y: number, width: number, height: number, ink: Ink): void {
  context.globalAlpha = 0.8;
  context.fillStyle = ink.halo;
  context.fillRect(x, y, width, height);
  context.globalAlpha = 1;
}

function label(context: Context, text: string, x: number, y: number, ink: Ink): void {
  context.fillStyle = ink.text;
  context.font = "12px system-ui, sans-serif";
  context.textAlign = "left";
  context.textBaseline = "middle";
  context.fillText(text, x, y);
}
