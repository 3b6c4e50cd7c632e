/** The marks of tracked features as paths of an SVG in the picture's pixels. Pure. */
import type { TrackedFeatures } from "../protocol/messages";

export type Kind = "both_eyes" | "one_eye" | "rejected";

export const KINDS: readonly { kind: Kind; sign: string; label: string }[] = [
  { kind: "both_eyes", sign: "○", label: "in both eyes" },
  { kind: "one_eye", sign: "△", label: "in one eye" },
  { kind: "rejected", sign: "×", label: "rejected" },
];

/** px of a picture of 640 x 480. */
const SIZE = 5;

/** Features of a picture further from this one in time are not drawn over it, ns. */
const APART = 300e6;

/** Around (0, 0). */
const SHAPES: Record<Kind, string> = {
  both_eyes: `m${-SIZE},0a${SIZE},${SIZE} 0 1 0 ${2 * SIZE},0a${SIZE},${SIZE} 0 1 0 ${-2 * SIZE},0`,
  one_eye: `m0,${-SIZE - 1}l${SIZE + 1},${2 * SIZE}h${-2 * (SIZE + 1)}z`,
  rejected: `m${-SIZE},${-SIZE}l${2 * SIZE},${2 * SIZE}m0,${-2 * SIZE}l${-2 * SIZE},${2 * SIZE}`,
};

export function marksOf(kind: Kind, places: readonly (readonly [number, number])[]): string {
  return places.map(([x, y]) => `M${x},${y}${SHAPES[kind]}`).join("");
}

export function together(features: TrackedFeatures, stamp_ns: number): boolean {
  return Math.abs(features.stamp_ns - stamp_ns) <= APART;
}
