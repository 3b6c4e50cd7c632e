/** What to do about what keeps the robot from moving or makes it less sure (docs/operators_guide.md). Pure. */

const ADVICE: readonly (readonly [RegExp, string])[] = [
  [/vision|odometry/i, "Wait: it goes on by itself when vision is back. Otherwise drive by hand, or sit."],
  [/no operator|nobody/i, "Take control."],
  [/tilt/i, "Drive back by hand, slowly."],
  [/celsius|servo|hot/i, "Let it rest; it sits down at 75 °C."],
  [/battery/i, "Bring it home; it sits down when the battery is empty."],
  [/slower|real time/i, "The computer is too slow for this world; nothing else is wrong."],
  [/stop/i, "Release the stop when the ground around the robot is clear."],
  [/stability|margin/i, "Lower the body or choose a wider gait; steer to more level ground."],
  [/conflict|two robots/i, "Stop one of them, or start it with another id."],
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

/** Servos sit the robot down at 75 °C, so the operator hears of it before. */
const WARM = 65;
const LOW_BATTERY = 0.2;
const SLOW_PACE = 0.9;

export function alertsOf({ reasons, temperature, battery, pace, odometry }: Findings): Alert[] {
  const found = [...reasons];
  if (temperature !== null && temperature >= WARM) found.push(`a servo is at ${temperature.toFixed(0)} °C: hot`);
  if (battery !== null && battery < LOW_BATTERY) found.push(`the battery is at ${(100 * battery).toFixed(0)} %`);
  if (pace !== null && pace < SLOW_PACE) found.push(`simulated time runs slower: ${pace.toFixed(2)} of real time`);
  if (odometry === "lost" || odometry === "degraded") found.push(`odometry is ${odometry}`);
  return found.map((text) => ({ text, advice: adviceFor(text) }));
}

function adviceFor(text: string): string {
  return ADVICE.find(([pattern]) => pattern.test(text))?.[1] ?? "It vanishes from this list when it is fixed.";
}
