/** The target as a person describes it, and as the calibrator wants to be told. */

export type TargetKind = "aprilgrid" | "checkerboard";

export interface TargetForm {
  kind: TargetKind;
  columns: number;
  rows: number;
  /** Edge of a tag or square, mm. */
  size: number;
  /** Gap between tags over their size. */
  spacing: number;
}

export const USUAL: TargetForm = { kind: "aprilgrid", columns: 6, rows: 6, size: 88, spacing: 0.3 };

/** What is wrong with a target, in words; null when nothing is. */
export function faultOf({ kind, columns, rows, size, spacing }: TargetForm): string | null {
  const least = kind === "aprilgrid" ? 1 : 3;
  if (!Number.isInteger(columns) || !Number.isInteger(rows) || Math.min(columns, rows) < least || columns * rows > 587) {
    return `Columns and rows are whole numbers from ${least} up.`;
  }
  if (!(size >= 1 && size <= 10_000)) return "A size is from 1 to 10000 mm.";
  if (kind === "aprilgrid" && !(spacing >= 0.05 && spacing <= 1)) return "A spacing is from 0.05 to 1.";
  return null;
}

export function wordsOf({ kind, columns, rows, size, spacing }: TargetForm, recording: string): string {
  const numbers = kind === "aprilgrid" ? [columns, rows, size / 1000, spacing] : [columns, rows, size / 1000];
  return `${kind} ${numbers.join(" ")}${recording === "" ? "" : ` from ${recording}`}`;
}

const STEPS = ["lens of the left eye", "lens of the right eye", "both eyes together"];

/** How many of the three steps of solving are done, from the name of the one that runs. */
export function stepsDone(step: string): number {
  return Math.max(0, STEPS.indexOf(step));
}
export const STEP_COUNT = STEPS.length;
