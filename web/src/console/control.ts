/** What this page may do: whether it holds control, and whether the robot would accept a command now. */
import { onlyWatching } from "../access/role";
import type { CommandName } from "../protocol/messages";
import { freshness, limitsOf } from "./freshness";
import { type ConsoleState, latest, useConsole } from "./store";
import type { RobotEntry } from "../protocol/wire";

export function selectedRobot(state: ConsoleState): RobotEntry | undefined {
  return state.robots.find((robot) => robot.id === state.selected);
}

/** The operator holding the selected robot, empty when free. */
export function holder(state: ConsoleState): string {
  return latest(state, "state/lease")?.value.holder ?? "";
}

export function holdsControl(state: ConsoleState): boolean {
  const lease = latest(state, "state/lease");
  if (selectedRobot(state)?.kind === "REPLAY") return false; // it tells who had control then
  if (lease === undefined || state.hello === null || lease.value.holder !== state.hello.operator) return false;
  const { level } = freshness(lease.received, state.now, limitsOf("state/lease"), true);
  return level === "live" || level === "stale";
}

/** Why nothing at all can be asked of the robot now, in words; null when it can. */
export function unreachable(state: ConsoleState): string | null {
  if (state.connection !== "open") return "the console is unreachable";
  const watching = onlyWatching(state);
  if (watching !== null) return watching;
  if (selectedRobot(state) === undefined) return "no robot is selected";
  if (selectedRobot(state)?.kind === "REPLAY") return "this is a recording, not a robot";
  if (selectedRobot(state)?.alive === false) return "the robot is silent";
  return null;
}

/** Why a command can not be given now, in words; null when it can. */
export function hindrance(state: ConsoleState, command: CommandName): string | null {
  const silence = unreachable(state);
  if (silence !== null) return silence;
  if (!holdsControl(state)) return "take control first";
  const mode = latest(state, "state/mode")?.value;
  if (mode === undefined) return "the robot has not told its state yet";
  if (mode.allowed.includes(command) || (command === "stand" && UPRIGHT.has(mode.mode))) return null;
  return mode.reasons[0] ?? `not possible in ${mode.mode}`;
}

/** Standing up again does no harm, so it is not refused here. */
const UPRIGHT = new Set(["STAND", "WALK", "HOLD"]);

export function useHindrance(command: CommandName): string | null {
  return useConsole((state) => hindrance(state, command));
}
