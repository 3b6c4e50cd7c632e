/** Keys, pad and gamepad to stick positions. Pure: the clock is an argument, nothing is sent from here.
 *  Without the dead-man every frame is zero; a few such frames follow its release, then silence. */

export interface Stick {
  /** -1..1 of the robot's limits: ahead, to the left, turning left. */
  forward: number;
  left: number;
  turn: number;
}

export interface TeleopFrame extends Stick {
  dead_man: boolean;
}

export interface Inputs {
  /** `KeyboardEvent.code` of the keys held down. */
  keys: ReadonlySet<string>;
  /** Held by hand: the button on the page, the Shift key, a trigger of the gamepad. */
  deadMan: boolean;
  /** Position of the on-screen pad, null when untouched. */
  pad: Stick | null;
  gamepad: Stick | null;
  /** 0..1, what the operator allows at most. */
  limit: number;
}

export const REST: Stick = { forward: 0, left: 0, turn: 0 };
/** Seconds between two frames (20 Hz). */
export const FRAME_PERIOD = 0.05;
const FAREWELL_FRAMES = 3;

const KEYS: Record<string, Stick> = {
  KeyW: { forward: 1, left: 0, turn: 0 },
  ArrowUp: { forward: 1, left: 0, turn: 0 },
  KeyS: { forward: -1, left: 0, turn: 0 },
  ArrowDown: { forward: -1, left: 0, turn: 0 },
  KeyA: { forward: 0, left: 1, turn: 0 },
  KeyD: { forward: 0, left: -1, turn: 0 },
  KeyQ: { forward: 0, left: 0, turn: 1 },
  ArrowLeft: { forward: 0, left: 0, turn: 1 },
  KeyE: { forward: 0, left: 0, turn: -1 },
  ArrowRight: { forward: 0, left: 0, turn: -1 },
};

export function isDrivingKey(code: string): boolean {
  return code in KEYS;
}

/** All inputs together, scaled by the limit; a stick that says nothing sensible counts as at rest. */
export function stickOf({ keys, deadMan, pad, gamepad, limit }: Inputs): Stick {
  if (!deadMan) return REST;
  const parts = [...[...keys].map((code) => KEYS[code] ?? REST), pad ?? REST, gamepad ?? REST];
  const sum = (axis: keyof Stick) => parts.reduce((total, part) => total + finite(part[axis]), 0);
  const scaled = (axis: keyof Stick) => clamp(sum(axis), -1, 1) * clamp(limit, 0, 1);
  return { forward: scaled("forward"), left: scaled("left"), turn: scaled("turn") };
}

/** Decides when a frame is due. `now` in seconds of any clock that only goes forward. */
export class TeleopSampler {
  private due = -Infinity;
  private farewells = 0;

  /** The frame to send now, null for none. */
  sample(inputs: Inputs, now: number): TeleopFrame | null {
    if (inputs.deadMan) {
      this.farewells = FAREWELL_FRAMES;
      if (now < this.due) return null;
      this.due = now + FRAME_PERIOD;
      return { dead_man: true, ...stickOf(inputs) };
    }
    if (this.farewells === 0) return null;
    this.farewells--;
    this.due = -Infinity;
    return { dead_man: false, ...REST };
  }
}

function finite(value: number): number {
  return Number.isFinite(value) ? value : 0;
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(finite(value), low), high);
}
