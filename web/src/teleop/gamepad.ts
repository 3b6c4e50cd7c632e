/** The first gamepad with the standard layout: left stick walks, right stick turns, a shoulder button is the dead-man. */
import { REST, type Stick } from "./sampler";

const DEAD_ZONE = 0.12;
const SHOULDERS = [4, 5];

export interface GamepadReading {
  stick: Stick;
  deadMan: boolean;
  name: string;
}

/** Null without a gamepad: one that was unplugged says nothing more. */
export function readGamepad(gamepads: readonly (Gamepad | null)[]): GamepadReading | null {
  const pad = gamepads.find((candidate) => candidate !== null && candidate.connected);
  if (pad === undefined || pad === null) return null;
  const axis = (index: number) => outsideDeadZone(pad.axes[index] ?? 0);
  const deadMan = SHOULDERS.some((index) => pad.buttons[index]?.pressed === true);
  const stick = deadMan ? { forward: 0 - axis(1), left: 0 - axis(0), turn: 0 - axis(2) } : REST;
  return { stick, deadMan, name: pad.id };
}

function outsideDeadZone(value: number): number {
  const size = Math.abs(value);
  return size < DEAD_ZONE ? 0 : (Math.sign(value) * (size - DEAD_ZONE)) / (1 - DEAD_ZONE);
}
