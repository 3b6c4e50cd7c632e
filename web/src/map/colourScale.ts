/** Values to colours by the legend the console sends, so that the 2-D map and the 3-D view agree. */
import type { Legend } from "../protocol/wire";

export type Rgb = readonly [red: number, green: number, blue: number];

export interface ColourScale {
  readonly layer: string;
  readonly unit: string;
  readonly stops: readonly (readonly [value: number, colour: Rgb])[];
  readonly unknown: Rgb;
}

export function colourScale(legend: Pick<Legend, "layer" | "unit" | "stops" | "unknown">): ColourScale {
  return {
    layer: legend.layer,
    unit: legend.unit,
    stops: legend.stops.map(([value, colour]) => [value, parseColour(colour)] as const),
    unknown: parseColour(legend.unknown),
  };
}

/** The trail's colours by the cost of transport, as in the 3-D view. */
export const TRANSPORT: ColourScale = {
  layer: "transport",
  unit: "",
  stops: [
    [2, parseColour("#2c6e63")],
    [6, parseColour("#a3bd5c")],
    [10, parseColour("#e3d35f")],
    [15, parseColour("#d96c3c")],
    [20, parseColour("#b03034")],
  ],
  unknown: [128, 128, 128],
};

/** Joints by their share of the servo's stall torque, as in the 3-D view. */
export const TORQUE: ColourScale = {
  layer: "torque",
  unit: "",
  stops: [
    [0, parseColour("#2c3038")],
    [0.25, parseColour("#3d6fa5")],
    [0.5, parseColour("#e3d35f")],
    [0.8, parseColour("#d96c3c")],
    [1, parseColour("#d01c1c")],
  ],
  unknown: [128, 128, 128],
};

/** Linear between stops, clamped outside; NaN is the colour of the unknown. */
export function colourOf(scale: ColourScale, value: number): Rgb {
  const { stops } = scale;
  const first = stops[0];
  if (Number.isNaN(value) || first === undefined) return scale.unknown;
  let before = first;
  for (const stop of stops) {
    if (value <= stop[0]) return between(before, stop, value);
    before = stop;
  }
  return before[1];
}

export function parseColour(text: string): Rgb {
  const value = Number.parseInt(text.replace("#", ""), 16);
  return Number.isNaN(value) ? [128, 128, 128] : [(value >> 16) & 255, (value >> 8) & 255, value & 255];
}

function between(a: readonly [number, Rgb], b: readonly [number, Rgb], value: number): Rgb {
  const span = b[0] - a[0];
  const t = span > 0 ? Math.max(0, (value - a[0]) / span) : 1;
  return [0, 1, 2].map((k) => Math.round(a[1][k]! + t * (b[1][k]! - a[1][k]!))) as unknown as Rgb;
}
