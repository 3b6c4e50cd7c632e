import { describe, expect, it } from "vitest";
import { colourOf, colourScale } from "../src/map/colourScale";
import { type TileMessage, TileMap, cellValue, decodeTile } from "../src/map/tiles";

const base64 = (bytes: Uint8Array) => btoa(String.fromCharCode(...bytes));
const heights = new Int16Array([100, -250, -32768, 0]);

const message: TileMessage = {
  stamp_ns: 1,
  i: 2,
  j: -1,
  size: 2,
  cell: 0.04,
  elevation_mm: base64(new Uint8Array(heights.buffer)),
  sigma_mm: base64(new Uint8Array([5, 5, 255, 5])),
  roughness: base64(new Uint8Array([0, 100, 255, 200])),
  step_height: base64(new Uint8Array([200, 0, 255, 50])),
  age_s: base64(new Uint8Array([0, 3, 255, 254])),
};

describe("a terrain tile", () => {
  const tile = decodeTile(message, 0)!;

  it("has each layer in its unit, and NaN where nothing is known", () => {
    expect([0, 1, 2, 3].map((k) => cellValue(tile, "elevation", k))).toEqual([0.1, -0.25, NaN, 0]);
    expect([0, 1, 2, 3].map((k) => cellValue(tile, "roughness", k))).toEqual([0, 0.5, NaN, 1]);
    expect([0, 1, 2, 3].map((k) => cellValue(tile, "step_height", k))).toEqual([1, 0, NaN, 0.25]);
    expect([0, 1, 2, 3].map((k) => cellValue(tile, "age", k))).toEqual([0, 3, NaN, 254]);
  });

  it("is refused when a layer has not its size", () => {
    expect(decodeTile({ ...message, roughness: base64(new Uint8Array(3)) }, 0)).toBeNull();
    expect(decodeTile({ ...message, elevation_mm: base64(new Uint8Array(4)) }, 0)).toBeNull();
  });

  it("replaces the older one of its place and goes when it is forgotten", () => {
    const map = new TileMap();
    map.put("a", message, 0);
    map.put("a", message, 1);
    expect([map.tiles.size, map.version]).toEqual([1, 2]);
    map.forget((key) => key === "a");
    expect([map.tiles.size, map.version]).toEqual([0, 3]);
  });
});

it("colours by the console's legend, clamped outside", () => {
  const stops: [number, string][] = [
    [0, "#000000"],
    [1, "#ff8000"],
  ];
  const scale = colourScale({ layer: "roughness", unit: "", stops, unknown: "#010203" });
  expect(colourOf(scale, -1)).toEqual([0, 0, 0]);
  expect(colourOf(scale, 0.5)).toEqual([128, 64, 0]);
  expect(colourOf(scale, 7)).toEqual([255, 128, 0]);
  expect(colourOf(scale, NaN)).toEqual([1, 2, 3]);
});
