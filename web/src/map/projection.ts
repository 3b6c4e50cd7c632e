/** Between world (m, x to the right, y up) and the pixels of the 2-D map (x to the right, y down). */

export interface View {
  /** World point at the middle of the canvas, m. */
  readonly x: number;
  readonly y: number;
  /** Pixels per metre. */
  readonly scale: number;
  readonly width: number;
  readonly height: number;
}

export interface Point {
  x: number;
  y: number;
}

const SMALLEST_SCALE = 4;
const LARGEST_SCALE = 1000;

export function toScreen(view: View, world: Point): Point {
  return {
    x: view.width / 2 + (world.x - view.x) * view.scale,
    y: view.height / 2 - (world.y - view.y) * view.scale,
  };
}

export function toWorld(view: View, screen: Point): Point {
  return {
    x: view.x + (screen.x - view.width / 2) / view.scale,
    y: view.y - (screen.y - view.height / 2) / view.scale,
  };
}

/** Moves the picture by pixels: what was under the pointer stays under it. */
export function pan(view: View, dx: number, dy: number): View {
  return { ...view, x: view.x - dx / view.scale, y: view.y + dy / view.scale };
}

/** Zooms by `factor` about a point of the screen, which keeps its place. */
export function zoomAt(view: View, screen: Point, factor: number): View {
  const fixed = toWorld(view, screen);
  const scale = Math.min(Math.max(view.scale * factor, SMALLEST_SCALE), LARGEST_SCALE);
  return {
    ...view,
    scale,
    x: fixed.x - (screen.x - view.width / 2) / scale,
    y: fixed.y + (screen.y - view.height / 2) / scale,
  };
}

/** A round length in metres (1, 2 or 5 times a power of ten) of at most `pixels` on the screen. */
export function scaleBarLength(scale: number, pixels: number): number {
  const most = pixels / scale;
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].map((digit) => digit * power).find((length) => length <= most) ?? power;
}

/** Heading about world z of a w-first quaternion, rad. */
export function yawOf([w, x, y, z]: readonly [number, number, number, number]): number {
  return Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}
