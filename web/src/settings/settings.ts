/** Everything of the robot that an operator sets by a number, with its bounds, to be found by its name. Pure. */
import type { Parameter } from "../adaptation/parameters";
import { type Axis, POSE_AXES, robotValue, shownValue } from "../body/axes";
import type { CommandName } from "../protocol/messages";
import type { CommandFields } from "../protocol/wire";

export interface Setting {
  readonly label: string;
  readonly unit: string;
  readonly digits: number;
  readonly lower: number;
  readonly upper: number;
  /** As shown; null unknown. */
  readonly value: number | null;
  readonly command: CommandName;
  fields(shown: number): CommandFields;
}

/** s that a value set here replaces the adapted one. */
export const HELD = 300;

export function ofParameter({ name, label, unit, digits, lower, upper }: Parameter, value: number | null): Setting {
  const fields = (shown: number) => ({ name, value: shown, seconds: HELD });
  return { label, unit, digits, lower, upper, value, command: "set_override", fields };
}

export function ofPose(pose: readonly (number | null)[] | undefined, largest: readonly number[]): Setting[] {
  return POSE_AXES.map((axis, index) => {
    const upper = shownValue(axis, largest[index] ?? 0);
    const value = pose?.[index] ?? null;
    return { ...axisOf(axis), lower: -upper, upper, value: value === null ? null : shownValue(axis, value) };
  });
}

function axisOf(axis: Axis): Pick<Setting, "label" | "unit" | "digits" | "command" | "fields"> {
  const { label, unit, digits, name } = axis;
  return { label, unit, digits, command: "set_pose", fields: (shown) => ({ name, value: robotValue(axis, shown) }) };
}

/** Those in whose name or unit every word of the search is. */
export function found(settings: readonly Setting[], search: string): Setting[] {
  const words = search.toLowerCase().split(/\s+/).filter(Boolean);
  return settings.filter(({ label, unit }) => words.every((word) => `${label} ${unit}`.toLowerCase().includes(word)));
}

/** Why a value is not taken; null when it is. */
export function outside({ lower, upper, digits, unit }: Setting, value: number): string | null {
  if (value >= lower && value <= upper) return null;
  return `it goes from ${lower.toFixed(digits)} to ${upper.toFixed(digits)} ${unit}`;
}
