/** What to do about what keeps the robot from moving or makes it less sure (docs/operators_guide.md). Pure. */

import { HOT, WARM } from "../robot/heat";

const WATCH_IT = "Stand clear; look at the robot before anything else.";
const WIRES = "Let it sit and cut the torque; check cables and power, then run `weaver doctor`.";

/** The first that fits counts: what is particular stands before what is general. */
const ADVICE: readonly (readonly [RegExp, string])[] = [
  [/vision|odometry/i, "Wait: it goes on by itself when vision is back. Otherwise drive by hand, or sit."],
  [/no operator|nobody|operator has been silent/i, "Take control."],
  [/fallen over/i, `${WATCH_IT} Set it on its belly by hand, then release the stop.`],
  [/tilt/i, "Drive back by hand, slowly."],
  [/is stuck/i, `${WATCH_IT} Free the leg: until then its motor keeps a third of its torque.`],
  [/has stopped: nothing was heard/i, "It goes on softly by itself; if it comes again, the computer is too busy."],
  [/celsius|°C/i, `Let it rest; it sits down at ${HOT} °C.`],
  [/\bIMU\b|attitude|gravity/, `It can not walk without its IMU. ${WIRES}`],
  [/power monitor/i, "Watch the battery yourself; it sits down after 5 s. Check the monitor's cable."],
  [/longer than a tick/i, "Expect it to walk less well until that is set; `weaver doctor` tells where."],
  [/servo|bus .* is down|supply/i, WIRES],
  [/battery/i, "Bring it home; it sits down when the battery is empty."],
  [/slower|real time/i, "The computer is too slow for this world; nothing else is wrong."],
  [/stop/i, "Release the stop when the ground around the robot is clear."],
  [/stability|margin/i, "Lower the body or choose a wider gait; steer to more level ground."],
  [/held for/i, "It sits down by itself; see above what keeps it from walking."],
];

export interface Alert {
  text: string;
  advice: string;
}

export interface Findings {
  reasons: readonly string[];
  temperature: number | null;
  battery: number | null;
  pace: number | null;
  odometry: string;
}

const LOW_BATTERY = 0.2;
const SLOW_PACE = 0.9;

export function alertsOf({ reasons, temperature, battery, pace, odometry }: Findings): Alert[] {
  const found = [...reasons];
  if (temperature !== null && temperature >= WARM) found.push(`a servo is at ${temperature.toFixed(0)} °C`);
  if (battery !== null && battery < LOW_BATTERY) found.push(`the battery is at ${(100 * battery).toFixed(0)} %`);
  if (pace !== null && pace < SLOW_PACE) found.push(`simulated time runs slower: ${pace.toFixed(2)} of real time`);
  if (odometry === "lost" || odometry === "degraded") found.push(`odometry is ${odometry}`);
  return found.map((text) => ({ text, advice: adviceFor(text) }));
}

function adviceFor(text: string): string {
  return ADVICE.find(([pattern]) => pattern.test(text))?.[1] ?? "It vanishes from this list when it is fixed.";
}
