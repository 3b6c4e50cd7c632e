/** The axes along and about which an operator may move the body, a lifted foot and the walking robot. */

export interface Axis {
  readonly name: string;
  readonly label: string;
  readonly unit: string;
  readonly digits: number;
  /** What is shown is the robot's value times this. */
  readonly scale: number;
  readonly step: number;
}

const CENTIMETRES = { unit: "cm", digits: 1, scale: 100, step: 0.1 };
const DEGREES = { unit: "°", digits: 1, scale: 180 / Math.PI, step: 0.5 };

export const POSE_AXES: readonly Axis[] = [
  { name: "x", label: "Body forward", ...CENTIMETRES },
  { name: "y", label: "Body to the left", ...CENTIMETRES },
  { name: "z", label: "Body up", ...CENTIMETRES },
  { name: "roll", label: "Body roll", ...DEGREES },
  { name: "pitch", label: "Body pitch", ...DEGREES },
  { name: "yaw", label: "Body yaw", ...DEGREES },
];

export const TIP_AXES: readonly Axis[] = [
  { name: "x", label: "Foot forward", ...CENTIMETRES },
  { name: "y", label: "Foot to the left", ...CENTIMETRES },
  { name: "z", label: "Foot up", ...CENTIMETRES },
];

export const CRUISE_AXES: readonly Axis[] = [
  { name: "forward", label: "Cruise forward", unit: "m/s", digits: 2, scale: 1, step: 0.01 },
  { name: "left", label: "Cruise to the left", unit: "m/s", digits: 2, scale: 1, step: 0.01 },
  { name: "turn", label: "Cruise turn to the left", unit: "°/s", digits: 0, scale: 180 / Math.PI, step: 1 },
];

/** The robot's value as it is shown, with the digits it is set in. */
export function shownValue(axis: Axis, value: number): number {
  return Number((axis.scale * value).toFixed(axis.digits)) + 0;
}

export function robotValue(axis: Axis, shown: number): number {
  return shown / axis.scale;
}
