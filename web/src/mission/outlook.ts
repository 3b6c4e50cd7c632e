/** What a way will take, from the pace and energy that the robot tells; unknown stays unknown. */
import type { MissionOutlook } from "../protocol/messages";

export interface Estimate {
  /** s, NaN unknown. */
  seconds: number;
  /** J, NaN unknown. */
  joules: number;
}

export function estimate(metres: number | null | undefined, outlook: MissionOutlook | undefined): Estimate {
  const { speed, energy_per_metre } = outlook ?? {};
  if (typeof metres !== "number") return { seconds: NaN, joules: NaN };
  return {
    seconds: typeof speed === "number" && speed > 0 ? metres / speed : NaN,
    joules: typeof energy_per_metre === "number" ? metres * energy_per_metre : NaN,
  };
}

/** "2:05 min": a duration as minutes and seconds. */
export function spokenDuration(seconds: number): string {
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

/** The basis of the figures in a sentence with units; nothing before the robot has told any. */
export function basis(outlook: MissionOutlook | undefined): string {
  if (outlook === undefined || typeof outlook.speed !== "number") return "";
  const speed = `${outlook.speed.toFixed(2)} m/s`;
  if (outlook.speed_basis === "gait") {
    return `The least time, at ${speed}: the most that the present stride frequency allows. Energy is known after 0.5 m.`;
  }
  const { energy_per_metre: energy, cost_of_transport: cost } = outlook;
  const dear = typeof energy === "number" ? `, ${energy.toFixed(0)} J/m` : "";
  const transport = typeof cost === "number" ? ` (cost of transport ${cost.toFixed(1)})` : "";
  return `At ${speed}${dear}${transport}, measured over the last ${outlook.measured_over.toFixed(1)} m of missions.`;
}
