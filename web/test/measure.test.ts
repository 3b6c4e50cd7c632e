import { describe, expect, it } from "vitest";
import { TileMap } from "../src/map/tiles";
import { described, heightAt } from "../src/measure/distance";

const base64 = (bytes: Uint8Array) => btoa(String.fromCharCode(...bytes));

function tile(i: number, j: number, millimetres: number[]) {
  const cells = new Uint8Array(new Int16Array(millimetres).buffer);
  const flat = base64(new Uint8Array(4));
  return {
    stamp_ns: 1, i, j, size: 2, cell: 0.5, elevation_mm: base64(cells), sigma_mm: flat, roughness: flat,
    step_height: flat, age_s: flat,
  }; // prettier-ignore
}

describe("heights", () => {
  const map = new TileMap();
  map.put("tele/map/tile/0_0", tile(0, 0, [10, 20, 30, -32768]), 0);
  map.put("tele/map/tile/-1_0", tile(-1, 0, [50, 60, 70, 80]), 0);

  it("are those of the cell that a place lies in, on either side of the origin", () => {
    expect(heightAt(map, { x: 0.2, y: 0.7 })).toBeCloseTo(0.02);
    expect(heightAt(map, { x: 0.7, y: 0.2 })).toBeCloseTo(0.03);
    expect(heightAt(map, { x: -0.2, y: 0.7 })).toBeCloseTo(0.08);
  });

  it("are unknown where nothing was seen", () => {
    expect(heightAt(map, { x: 0.7, y: 0.7 })).toBeNaN();
    expect(heightAt(map, { x: 5, y: 5 })).toBeNaN();
    expect(heightAt(new TileMap(), { x: 0, y: 0 })).toBeNaN();
  });
});

it("a measure is told as length, rise and slope", () => {
  expect(described({ x: 0, y: 0 }, { x: 3, y: 4 }, [0.1, 0.6])).toBe("5.00 m, 0.50 m up, 6°");
  expect(described({ x: 0, y: 0 }, { x: 1, y: 0 }, [0.5, 0.4])).toBe("1.00 m, 0.10 m down, 6°");
  expect(described({ x: 0, y: 0 }, { x: 1, y: 0 }, [NaN, 0.4])).toBe("1.00 m, heights unknown");
});
