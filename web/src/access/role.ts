/** What the user of this page may do. */
import type { ConsoleState } from "../console/store";

/** Why this page may not command at all, in words; null when it may. */
export function onlyWatching(state: Pick<ConsoleState, "hello">): string | null {
  return state.hello?.role === "viewer" ? "you are a viewer, who may watch and stop the robot" : null;
}
