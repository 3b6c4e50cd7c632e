/** Beginning a replay: the robot's recorder plays the file as a robot of its own, which the page goes to when it is there. */
import { command } from "../console/commands";
import { selectedRobot } from "../console/control";
import { selectRobot } from "../console/outbox";
import { type ConsoleState, useConsole } from "../console/store";
import { replayIdOf } from "./timeline";

/** How long the page waits for a replay to appear, ms. */
const PATIENCE = 15_000;

export async function startReplay(recording: string): Promise<void> {
  const { accepted } = await command("start_replay", { name: recording });
  if (accepted) goToWhenThere(replayIdOf(recording));
}

/** Ends the replay for everybody who watches it, and goes back to the robot that was recorded. */
export async function endReplay(recorded: string): Promise<void> {
  const { accepted } = await command("end_replay");
  if (!accepted) return;
  const known = useConsole.getState().robots.some((robot) => robot.id === recorded);
  selectRobot(known ? recorded : null);
}

export function useIsReplay(): boolean {
  return useConsole((state) => selectedRobot(state)?.kind === "REPLAY");
}

function goToWhenThere(id: string): void {
  const there = (state: ConsoleState) => state.robots.some((robot) => robot.id === id && robot.alive);
  const go = () => {
    end();
    selectRobot(id);
  };
  const unsubscribe = useConsole.subscribe((state) => there(state) && go());
  const timer = setTimeout(() => end(), PATIENCE);
  function end(): void {
    unsubscribe();
    clearTimeout(timer);
  }
  if (there(useConsole.getState())) go();
}
