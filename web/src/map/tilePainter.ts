/** One small picture per tile, a pixel a cell, painted anew only when the tile or the colours changed. */
import { type ColourScale, colourOf } from "./colourScale";
import { type LayerName, type Tile, cellValue } from "./tiles";

interface Painted {
  tile: Tile;
  scale: ColourScale;
  contours: boolean;
  picture: HTMLCanvasElement;
}

/** How strongly slopes are shaded in the elevation layer. */
const RELIEF = 1.6;
/** Standard deviation (mm) from which a cell is drawn pale, since its height is mostly guessed. */
const UNSURE_MM = 60;
/** m between two contour lines, as in the 3-D view. */
const CONTOUR_INTERVAL = 0.05;
const LINE_SHADE = 0.55;
const SURE_ALPHA = 255;
const UNSURE_ALPHA = 130;

export class TilePainter {
  private readonly painted = new Map<string, Painted>();

  picture(key: string, tile: Tile, scale: ColourScale, contours: boolean): HTMLCanvasElement {
    const old = this.painted.get(key);
    if (old?.tile === tile && old.scale === scale && old.contours === contours) return old.picture;
    const picture = old?.picture ?? document.createElement("canvas");
    paint(picture, tile, scale, contours);
    this.painted.set(key, { tile, scale, contours, picture });
    return picture;
  }

  clear(): void {
    this.painted.clear();
  }
}

/** Cell (r, c) lies at column r and, since y points up in the world and down in a picture, row size - 1 - c. */
function paint(picture: HTMLCanvasElement, tile: Tile, scale: ColourScale, contours: boolean): void {
  const { size } = tile;
  picture.width = picture.height = size;
  const context = picture.getContext("2d");
  if (context === null) return;
  const image = context.createImageData(size, size);
  const layer = scale.layer as LayerName;
  for (let r = 0; r < size; r++) {
    for (let c = 0; c < size; c++) {
      const value = cellValue(tile, layer, r * size + c);
      if (Number.isNaN(value)) continue; // stays transparent: the hatching below shows
      const shade = layer === "elevation" ? relief(tile, r, c) : 1;
      const line = contours && onContour(tile, r, c) ? LINE_SHADE : 1;
      const [red, green, blue] = colourOf(scale, value);
      const at = 4 * ((size - 1 - c) * size + r);
      image.data[at] = red * shade * line;
      image.data[at + 1] = green * shade * line;
      image.data[at + 2] = blue * shade * line;
      image.data[at + 3] = layer !== "age" && layer !== "uncertainty" && (tile.sigma[r * size + c] ?? 255) > UNSURE_MM ? UNSURE_ALPHA : SURE_ALPHA;
    }
  }
  context.putImageData(image, 0, 0);
}

/** Whether the ground passes a whole multiple of the interval between this cell and the one before or beside it. */
function onContour(tile: Tile, r: number, c: number): boolean {
  const { size } = tile;
  const level = (row: number, column: number) =>
    row < 0 || column < 0 ? NaN : Math.floor(cellValue(tile, "elevation", row * size + column) / CONTOUR_INTERVAL);
  const here = level(r, c);
  return [level(r - 1, c), level(r, c - 1)].some((other) => !Number.isNaN(other) && other !== here);
}

/** Brightness of a slope lit from the upper left, 1 on level ground. */
function relief(tile: Tile, r: number, c: number): number {
  const { size, cell } = tile;
  const here = cellValue(tile, "elevation", r * size + c);
  const behind = r > 0 ? cellValue(tile, "elevation", (r - 1) * size + c) : NaN;
  const left = c < size - 1 ? cellValue(tile, "elevation", r * size + c + 1) : NaN;
  const slope = (Number.isNaN(behind) ? 0 : here - behind) + (Number.isNaN(left) ? 0 : here - left);
  return Math.min(1.25, Math.max(0.55, 1 + (RELIEF * slope) / (4 * cell)));
}
