/** The three gait parameters that follow the ground (ICRA'17 eqs. 9-11), with the range an operator may set. */
import type { ParameterName } from "../protocol/messages";

export interface Parameter {
  readonly name: ParameterName;
  readonly label: string;
  readonly unit: string;
  readonly digits: number;
  readonly lower: number;
  readonly upper: number;
  readonly step: number;
}

/** NOTE: the robot clamps by its own configuration; these only bound the sliders. */
export const ADAPTED: readonly Parameter[] = [
  { name: "virtual_stiffness", label: "Virtual stiffness", unit: "N/m", digits: 0, lower: 400, upper: 2500, step: 10 },
  { name: "stride_frequency", label: "Stride frequency", unit: "Hz", digits: 2, lower: 0.3, upper: 1.0, step: 0.01 },
  { name: "stride_height", label: "Stride height", unit: "m", digits: 3, lower: 0.05, upper: 0.14, step: 0.001 },
];
