/** The map without a mouse. */

export type MapKey =
  | { type: "pan"; dx: number; dy: number }
  | { type: "nudge"; dx: number; dy: number }
  | { type: "zoom"; factor: number }
  | { type: "add" }
  | { type: "delete" }
  | { type: "next" }
  | { type: "previous" }
  | { type: "deselect" }
  | { type: "centre" };

const ARROWS: Record<string, readonly [dx: number, dy: number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
const PAN = 0.5; // m
const NUDGE = 0.1; // m
const FINE_NUDGE = 0.01; // m

export const MAP_HELP =
  "Click adds a waypoint, Shift and click inserts one in the nearest leg, drag moves it, right click or Delete removes it. " +
  "Arrow keys move the map, or the selected waypoint by 0.1 m (with Shift by 0.01 m). " +
  "Enter adds a waypoint in the middle, N and P select the next and previous one, D deselects, plus and minus zoom, C centres on the robot.";

/** What a key means; null when it is not for the map. */
export function mapKey(event: { key: string; shiftKey: boolean }, hasSelection: boolean): MapKey | null {
  const arrow = ARROWS[event.key];
  if (arrow !== undefined) {
    const step = hasSelection ? (event.shiftKey ? FINE_NUDGE : NUDGE) : PAN;
    return { type: hasSelection ? "nudge" : "pan", dx: step * arrow[0], dy: step * arrow[1] };
  }
  switch (event.key) {
    case "+":
    case "=":
      return { type: "zoom", factor: 1.25 };
    case "-":
      return { type: "zoom", factor: 0.8 };
    case "Enter":
      return { type: "add" };
    case "Delete":
    case "Backspace":
      return hasSelection ? { type: "delete" } : null;
    case "n":
    case "N":
      return { type: "next" };
    case "p":
    case "P":
      return { type: "previous" };
    case "d":
    case "D":
      return { type: "deselect" };
    case "c":
    case "C":
      return { type: "centre" };
    default:
      return null;
  }
}
