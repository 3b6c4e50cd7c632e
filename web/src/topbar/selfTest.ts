/** What somebody should know of a real robot before its motors are theirs: battery, and what it finds wrong itself. */
import type { ModeState, PowerState } from "../protocol/messages";

export interface SelfTest {
  battery: string;
  /** What the robot says is wrong, and that it is silent; empty: nothing. */
  troubles: string[];
}

export function selfTest(power: PowerState | undefined, mode: ModeState | undefined): SelfTest {
  const volts = power?.battery_voltage ?? NaN;
  const fraction = power?.battery_fraction ?? NaN;
  const known = Number.isFinite(volts) && Number.isFinite(fraction);
  return {
    battery: known ? `${volts.toFixed(1)} V, ${Math.round(100 * fraction)} %` : "unknown: its power monitor is silent",
    troubles: mode === undefined ? ["the robot has not told its state"] : [...mode.reasons],
  };
}
