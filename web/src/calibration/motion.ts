/** The motions that tell camera and IMU apart, in words. */
import { fixed } from "../components/format";
import type { CalibrationMotion } from "../protocol/messages";

const ABOUT = { x: "roll", y: "nod", z: "left and right" };
const ALONG = { x: "forward and back", y: "left and right", z: "up and down" };

/** "Turn about x (roll)". */
export function nameOf({ kind, axis }: CalibrationMotion): string {
  return kind === "turn" ? `Turn about ${axis} (${ABOUT[axis]})` : `Push along ${axis} (${ALONG[axis]})`;
}

/** "now 0.62 rad/s, 0.3 is enough". */
export function nowOf({ now, least, unit }: CalibrationMotion): string {
  return `now ${fixed(now, 2)} ${unit === "m/s^2" ? "m/s²" : unit}, ${least} is enough`;
}

/** "2.1 of 4 s"; no more than was wanted. */
export function secondsOf({ seconds, wanted }: CalibrationMotion): string {
  return `${fixed(Math.min(seconds, wanted), 1)} of ${wanted} s`;
}
