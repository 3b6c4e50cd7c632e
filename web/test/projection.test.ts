import { describe, expect, it } from "vitest";
import { type View, pan, scaleBarLength, toScreen, toWorld, yawOf, zoomAt } from "../src/map/projection";

const view: View = { x: 1.5, y: -2, scale: 80, width: 640, height: 400 };
const points = [
  { x: 0, y: 0 },
  { x: 123, y: 377 },
  { x: 640, y: 400 },
];

describe("the projection of the map", () => {
  it("and back is the same point", () => {
    for (const point of points) {
      const back = toScreen(view, toWorld(view, point));
      expect(back.x).toBeCloseTo(point.x, 9);
      expect(back.y).toBeCloseTo(point.y, 9);
    }
  });

  it("has y up and its middle where it looks", () => {
    expect(toScreen(view, { x: 1.5, y: -2 })).toEqual({ x: 320, y: 200 });
    expect(toScreen(view, { x: 2.5, y: -1 })).toEqual({ x: 400, y: 120 });
  });

  it("keeps the point under the pointer when zooming", () => {
    for (const point of points) {
      const before = toWorld(view, point);
      const after = toWorld(zoomAt(view, point, 1.7), point);
      expect(after.x).toBeCloseTo(before.x, 9);
      expect(after.y).toBeCloseTo(before.y, 9);
    }
  });

  it("keeps the point under the pointer when panning", () => {
    const before = toWorld(view, { x: 100, y: 100 });
    const after = toWorld(pan(view, 30, -20), { x: 130, y: 80 });
    expect(after.x).toBeCloseTo(before.x, 9);
    expect(after.y).toBeCloseTo(before.y, 9);
  });

  it("stops zooming where nothing could be seen", () => {
    expect(zoomAt(view, points[0]!, 1e9).scale).toBe(1000);
    expect(zoomAt(view, points[0]!, 1e-9).scale).toBe(4);
  });
});

it("picks a round length for the scale bar that fits", () => {
  for (const scale of [4, 17, 80, 333, 1000]) {
    const length = scaleBarLength(scale, 120);
    expect(length * scale).toBeLessThanOrEqual(120.0001);
    expect(length * scale).toBeGreaterThan(120 / 2.51);
  }
  expect(scaleBarLength(80, 120)).toBe(1);
});

it("reads the heading of a turn about z", () => {
  for (const yaw of [-3, -1, 0, 0.5, 3]) {
    expect(yawOf([Math.cos(yaw / 2), 0, 0, Math.sin(yaw / 2)])).toBeCloseTo(yaw, 12);
  }
});
