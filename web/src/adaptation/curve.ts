/** The polynomials from the ground to the gait (ICRA'17 eqs. 9-11). Pure. */

/** Value = sum of roughness[i] r^i + sum of step_height[k] h^(k+1), within the bounds. */
export interface Curve {
  roughness: readonly number[];
  step_height: readonly number[];
  lower: number;
  upper: number;
}

export type Over = "roughness" | "step_height";

/** Over which of the two indices a curve is drawn: the one that it depends on most. */
export function drawnOver({ step_height }: Curve): Over {
  return step_height.length > 0 ? "step_height" : "roughness";
}

export function valueAt({ roughness, step_height, lower, upper }: Curve, r: number, h: number): number {
  const rough = roughness.reduce((sum, factor, power) => sum + factor * r ** power, 0);
  const stepped = step_height.reduce((sum, factor, k) => sum + factor * h ** (k + 1), 0);
  return Math.min(Math.max(rough + stepped, lower), upper);
}

/** Points of the curve over 0..1, the other index held at `other`. */
export function sampled(curve: Curve, other: number, count = 41): { at: number; value: number }[] {
  const over = drawnOver(curve);
  return Array.from({ length: count }, (_, k) => {
    const at = k / (count - 1);
    return { at, value: over === "roughness" ? valueAt(curve, at, other) : valueAt(curve, other, at) };
  });
}
