/** How warm a servo may get. Pure. */

/** °C from which a real robot's servo is given less torque. */
export const WARM = 65;
/** °C at which the robot sits down, 5 before the servo shuts down by itself. */
export const HOT = 75;

export type Heat = "warm" | "hot";

export function heatOf(temperature: number | null | undefined): Heat | null {
  if (typeof temperature !== "number" || !(temperature >= WARM)) return null;
  return temperature < HOT ? "warm" : "hot";
}
