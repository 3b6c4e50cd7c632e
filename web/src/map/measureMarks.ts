/** The measured line on the 2-D map. */
import type { Waypoint } from "../protocol/messages";
import { type View, toScreen } from "./projection";
import { type Context, type Ink, circle, polyline, strokeWithHalo } from "./strokes";

export function drawMeasure(context: Context, view: View, places: readonly Waypoint[], ink: Ink): void {
  if (places.length > 1) {
    polyline(context, view, places);
    strokeWithHalo(context, ink, ink.text, 2);
  }
  for (const place of places) {
    const { x, y } = toScreen(view, place);
    circle(context, x, y, 5);
    strokeWithHalo(context, ink, ink.text, 2);
  }
}
