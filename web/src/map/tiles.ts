/** The terrain map as the console sends it: square tiles of cells, one array per layer. */

export const LAYERS = ["elevation", "roughness", "step_height", "uncertainty", "age"] as const;
export type LayerName = (typeof LAYERS)[number];

export const LAYER_LABELS: Record<LayerName, string> = {
  elevation: "Elevation",
  roughness: "Roughness",
  step_height: "Step height",
  uncertainty: "Uncertainty",
  age: "Age",
};

export interface TileMessage {
  stamp_ns: number;
  i: number;
  j: number;
  size: number;
  cell: number;
  elevation_mm: string;
  sigma_mm: string;
  roughness: string;
  step_height: string;
  age_s: string;
}

export interface Tile {
  readonly i: number;
  readonly j: number;
  readonly size: number;
  /** Edge of a cell, m. */
  readonly cell: number;
  readonly elevation: Int16Array; // (size, size) mm
  readonly sigma: Uint8Array; // (size, size) mm
  readonly roughness: Uint8Array; // (size, size) 0..200
  readonly stepHeight: Uint8Array; // (size, size) 0..200
  readonly age: Uint8Array; // (size, size) s
  /** Page clock (ms) at which the ages above were true. */
  readonly received: number;
}

const UNKNOWN_ELEVATION = -32768;
const UNKNOWN_INDEX = 255;
const INDEX_ONE = 200;

export class TileMap {
  readonly tiles = new Map<string, Tile>();
  /** Grows with every change, so that whoever draws knows when to draw. */
  version = 0;

  put(key: string, message: TileMessage, received: number): void {
    const tile = decodeTile(message, received);
    if (tile === null) return;
    this.tiles.set(key, tile);
    this.version++;
  }

  forget(matches: (key: string) => boolean): void {
    for (const key of this.tiles.keys()) if (matches(key)) this.tiles.delete(key);
    this.version++;
  }
}

/** Null when an array has not the size that the tile claims. */
export function decodeTile(message: TileMessage, received: number): Tile | null {
  const cells = message.size * message.size;
  const elevation = bytesOf(message.elevation_mm);
  const layers = [message.sigma_mm, message.roughness, message.step_height, message.age_s].map(bytesOf);
  const [sigma, roughness, stepHeight, age] = layers;
  if (elevation.length !== 2 * cells || !sigma || !roughness || !stepHeight || !age) return null;
  if (layers.some((layer) => layer.length !== cells)) return null;
  return {
    i: message.i,
    j: message.j,
    size: message.size,
    cell: message.cell,
    elevation: new Int16Array(elevation.buffer, elevation.byteOffset, cells), // little-endian, as every browser's machine
    sigma,
    roughness,
    stepHeight,
    age,
    received,
  };
}

/** Value of a cell in the layer's unit (m, 1, 1, s), NaN where unknown. */
export function cellValue(tile: Tile, layer: LayerName, k: number): number {
  switch (layer) {
    case "elevation": {
      const value = tile.elevation[k] ?? UNKNOWN_ELEVATION;
      return value === UNKNOWN_ELEVATION ? NaN : value / 1000;
    }
    case "roughness":
      return index(tile.roughness[k]);
    case "step_height":
      return index(tile.stepHeight[k]);
    case "uncertainty": {
      const value = tile.sigma[k] ?? UNKNOWN_INDEX;
      return value === UNKNOWN_INDEX ? NaN : value / 1000;
    }
    case "age": {
      const value = tile.age[k] ?? UNKNOWN_INDEX;
      return value === UNKNOWN_INDEX ? NaN : value;
    }
  }
}

function index(value: number | undefined): number {
  return value === undefined || value === UNKNOWN_INDEX ? NaN : value / INDEX_ONE;
}

function bytesOf(base64: string): Uint8Array {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < bytes.length; k++) bytes[k] = text.charCodeAt(k);
  return bytes;
}
