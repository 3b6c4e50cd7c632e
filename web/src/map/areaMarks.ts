/** Forbidden ground on the 2-D map: red, outlined and crossed by its number; the one being drawn is open. */
import type { Area } from "../areas/area";
import { type View, toScreen } from "./projection";
import { type Context, type Ink, circle, polyline, strokeWithHalo } from "./strokes";

export function drawAreas(context: Context, view: View, areas: readonly Area[], drawing: Area | null, ink: Ink): void {
  areas.forEach((area, index) => {
    polyline(context, view, area);
    context.closePath();
    context.globalAlpha = 0.28;
    context.fillStyle = ink.forbidden;
    context.fill();
    context.globalAlpha = 1;
    strokeWithHalo(context, ink, ink.forbidden, 2);
    const middle = toScreen(view, centreOf(area));
    context.fillStyle = ink.text;
    context.font = "600 12px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillText(`forbidden ${index + 1}`, middle.x, middle.y);
  });
  if (drawing === null) return;
  polyline(context, view, drawing);
  context.setLineDash([4, 4]);
  strokeWithHalo(context, ink, ink.forbidden, 2);
  context.setLineDash([]);
  for (const corner of drawing) {
    const { x, y } = toScreen(view, corner);
    circle(context, x, y, 4);
    strokeWithHalo(context, ink, ink.forbidden, 2);
  }
}

function centreOf(area: Area) {
  const sum = area.reduce((total, { x, y }) => ({ x: total.x + x, y: total.y + y }), { x: 0, y: 0 });
  return { x: sum.x / area.length, y: sum.y / area.length };
}
