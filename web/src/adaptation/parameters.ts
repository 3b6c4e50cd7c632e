/** The three gait parameters that follow the ground (ICRA'17 eqs. 9-11), with the range an operator may set. */
import { useMemo } from "react";
import { selectedRobot } from "../console/control";
import { useConsole } from "../console/store";
import type { ParameterName } from "../protocol/messages";

export interface Parameter {
  readonly name: ParameterName;
  readonly label: string;
  readonly unit: string;
  readonly digits: number;
  readonly step: number;
  readonly lower: number;
  readonly upper: number;
}

/** Ranges as the shipped robots have them, shown while no robot has told its own. */
const ADAPTED: readonly Parameter[] = [
  { name: "virtual_stiffness", label: "Virtual stiffness", unit: "N/m", digits: 0, step: 10, lower: 400, upper: 2500 },
  { name: "stride_frequency", label: "Stride frequency", unit: "Hz", digits: 2, step: 0.01, lower: 0.3, upper: 1.5 },
  { name: "stride_height", label: "Stride height", unit: "m", digits: 3, step: 0.001, lower: 0.03, upper: 0.14 },
];

export function useParameters(): readonly Parameter[] {
  const told = useConsole((state) => selectedRobot(state)?.parameters);
  return useMemo(() => ADAPTED.map((parameter) => ({ ...parameter, ...range(told?.[parameter.name]) })), [told]);
}

function range(told: { lower: number; upper: number } | undefined): Partial<Parameter> {
  return told === undefined ? {} : { lower: told.lower, upper: told.upper };
}
