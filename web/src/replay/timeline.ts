/** Places on a replay's timeline. Pure. */
import type { ReplayMark } from "../protocol/messages";

export const SPEEDS = [0.25, 0.5, 1, 2, 5, 10] as const;

/** How far before an event to begin, s: what led to it is to be seen. */
export const LEAD = 1;

/** Closer than this to where the replay is counts as the same place, s. */
const SAME = 0.3;

/** The id under which a recording is replayed, as the recorder makes it. */
export function replayIdOf(recording: string): string {
  return `replay-${recording.replace(/\.mcap$/, "").replaceAll(/[^A-Za-z0-9_-]/g, "_")}`;
}

/** Where to go to for an event: a little before it. */
export function landing(mark: Pick<ReplayMark, "seconds">): number {
  return Math.max(mark.seconds - LEAD, 0);
}

/** The next event ahead of `seconds` (direction 1) or the one before it (-1); undefined when there is none. */
export function neighbourMark(
  marks: readonly ReplayMark[],
  seconds: number,
  direction: 1 | -1,
): ReplayMark | undefined {
  return direction > 0
    ? marks.find((mark) => landing(mark) > seconds + SAME)
    : marks.findLast((mark) => landing(mark) < seconds - SAME);
}

/** Index of the last event that had happened by then, -1 before the first. */
export function lastMark(marks: readonly ReplayMark[], seconds: number): number {
  return marks.findLastIndex((mark) => mark.seconds <= seconds + 0.05);
}
