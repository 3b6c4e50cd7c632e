/** What lies between two places: length seen from above, rise and slope. Pure. */
import type { TileMap } from "../map/tiles";
import { cellValue } from "../map/tiles";
import type { Waypoint } from "../protocol/messages";

/** Height of the ground in m, NaN where it is unknown. */
export function heightAt({ tiles }: Pick<TileMap, "tiles">, { x, y }: Waypoint): number {
  const any = tiles.values().next().value;
  if (any === undefined) return NaN;
  const [row, column] = [Math.floor(x / any.cell), Math.floor(y / any.cell)];
  const [i, j] = [Math.floor(row / any.size), Math.floor(column / any.size)];
  const tile = tiles.get(`tele/map/tile/${i}_${j}`);
  if (tile === undefined || tile.cell !== any.cell || tile.size !== any.size) return NaN;
  return cellValue(tile, "elevation", (row - i * any.size) * any.size + (column - j * any.size));
}

/** "1.20 m, 0.05 m up, 2°"; without a height only the length. */
export function described(from: Waypoint, to: Waypoint, heights: readonly [number, number]): string {
  const length = Math.hypot(to.x - from.x, to.y - from.y);
  const rise = heights[1] - heights[0];
  if (!Number.isFinite(rise)) return `${length.toFixed(2)} m, heights unknown`;
  const slope = (Math.atan2(Math.abs(rise), length) * 180) / Math.PI;
  return `${length.toFixed(2)} m, ${Math.abs(rise).toFixed(2)} m ${rise >= 0 ? "up" : "down"}, ${slope.toFixed(0)}°`;
}
