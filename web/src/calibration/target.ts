/** The target as a person describes it, and the calibration as the calibrator wants to be told. */

export type TargetKind = "aprilgrid" | "checkerboard";
export type Part = "cameras" | "imu";

export interface TargetForm {
  kind: TargetKind;
  columns: number;
  rows: number;
  /** Edge of a tag or square, mm. */
  size: number;
  /** Gap between tags over their size. */
  spacing: number;
}

/** What is calibrated: the part "imu" goes by the lenses of a calibration, or of the robot's description if "". */
export interface Choice {
  part: Part;
  lenses: string;
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

/** `recording` is "" for the robot as it is now. */
export function wordsOf(
  { kind, columns, rows, size, spacing }: TargetForm,
  { part, lenses }: Choice,
  recording: string,
): string {
  const numbers = kind === "aprilgrid" ? [columns, rows, size / 1000, spacing] : [columns, rows, size / 1000];
  const words = [part === "imu" ? "imu " : "", `${kind} ${numbers.join(" ")}`];
  if (part === "imu" && lenses !== "") words.push(` with ${lenses}`);
  if (recording !== "") words.push(` from ${recording}`);
  return words.join("");
}

/** When a calibration was made, from its folder's name, by the robot's clock; the name itself if it tells none. */
export function madeAt(folder: string): string {
  const match = /_(\d{4}-\d{2}-\d{2})_(\d{2})-(\d{2})-(\d{2})$/.exec(folder);
  return match === null ? folder : `${match[1]} ${match[2]}:${match[3]}:${match[4]}`;
}
