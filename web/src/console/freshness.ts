/** How far a value can be trusted by its age: live, stale (shown grey with its age) or lost (not shown). */

export type Level = "live" | "stale" | "lost" | "never";

export interface Limits {
  /** Seconds after which a value is stale. */
  stale: number;
  /** Seconds after which it is lost. */
  lost: number;
}

export interface Freshness {
  level: Level;
  /** Seconds since the robot said so; NaN when it never did. */
  age: number;
}

const LIMITS: readonly (readonly [prefix: string, limits: Limits])[] = [
  ["tele/state", { stale: 0.5, lost: 3 }],
  ["tele/gait", { stale: 1, lost: 3 }],
  ["tele/adaptation", { stale: 1, lost: 5 }],
  ["tele/power", { stale: 2, lost: 8 }],
  ["tele/servos", { stale: 2, lost: 8 }],
  ["tele/health", { stale: 3, lost: 8 }],
  ["tele/cam", { stale: 2, lost: 8 }],
  ["tele/map", { stale: Infinity, lost: Infinity }],
  ["tele/", { stale: 1, lost: 5 }],
  ["state/calibration", { stale: Infinity, lost: Infinity }],
  ["state/areas", { stale: 4, lost: 10 }],
  ["state/outlook", { stale: 2, lost: 5 }],
  ["state/recording", { stale: 4, lost: 10 }],
  ["state/", { stale: 1, lost: 5 }],
  ["truth/", { stale: 0.5, lost: 3 }],
];
const DEFAULT_LIMITS: Limits = { stale: 2, lost: 6 };

export function limitsOf(key: string): Limits {
  return LIMITS.find(([prefix]) => key.startsWith(prefix))?.[1] ?? DEFAULT_LIMITS;
}

/** `received` and `now` in milliseconds of one clock. Nothing is live while the console can not be reached. */
export function freshness(received: number | undefined, now: number, limits: Limits, connected: boolean): Freshness {
  if (received === undefined) return { level: "never", age: NaN };
  const age = Math.max(0, (now - received) / 1000);
  if (age >= limits.lost) return { level: "lost", age };
  if (age >= limits.stale || !connected) return { level: "stale", age };
  return { level: "live", age };
}

/** "0.4 s", "12 s", "3 min": an age as it is spoken. */
export function spokenAge(age: number): string {
  if (!Number.isFinite(age)) return "never";
  if (age < 1) return `${age.toFixed(1)} s`;
  if (age < 100) return `${Math.round(age)} s`;
  return `${Math.round(age / 60)} min`;
}
