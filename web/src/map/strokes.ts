/** Lines and circles of the 2-D map that stay visible on any ground. */
import { type Point, type View, toScreen } from "./projection";

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
  forbidden: string;
}

export type Context = CanvasRenderingContext2D;

export function polyline(context: Context, view: View, points: readonly Point[]): void {
  context.beginPath();
  points.forEach((point, k) => {
    const { x, y } = toScreen(view, point);
    if (k === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  });
}

export function circle(context: Context, x: number, y: number, radius: number): void {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
}

/** A line that stays visible on any ground: a halo under it. */
export function strokeWithHalo(context: Context, ink: Ink, colour: string, width: number): void {
  context.lineJoin = "round";
  context.strokeStyle = ink.halo;
  context.lineWidth = width + 2;
  context.stroke();
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke();
}

export function positionOf(position: readonly (number | null)[]): Point | null {
  const [x, y] = position;
  return typeof x === "number" && typeof y === "number" ? { x, y } : null;
}
