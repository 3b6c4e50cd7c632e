/** The robot's states in words. */
import type { Mode, ModeState } from "../protocol/messages";

type Tone = "good" | "active" | "caution" | "danger" | "quiet";

const WORDS: Record<Mode, readonly [words: string, tone: Tone]> = {
  OFF: ["motors off", "quiet"],
  READY: ["ready, not standing", "quiet"],
  STAND: ["standing", "good"],
  WALK: ["walking", "active"],
  SIT: ["sitting down", "quiet"],
  HOLD: ["holding still", "caution"],
  FAULT: ["fallen, or not safe to move", "danger"],
  ESTOP: ["stopped", "danger"],
};

export function modeWords(mode: string): string {
  return WORDS[mode as Mode]?.[0] ?? "unknown state";
}

export function modeTone(state: ModeState): Tone {
  return state.stopped ? "danger" : (WORDS[state.mode]?.[1] ?? "caution");
}
