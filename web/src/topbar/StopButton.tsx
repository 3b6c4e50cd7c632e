/** The stop control: always in the same place, never disabled, needs no control of the robot. */
import { stopRobot } from "../console/commands";
import { useLatest } from "../console/useLatest";
import { useConsole } from "../console/store";

export function StopButton() {
  const stopped = useLatest("state/mode")?.stopped ?? false;
  const pending = useConsole((state) => state.stopPending);
  return (
    <button type="button" className="stop" aria-keyshortcuts="Escape Space" onClick={stopRobot}>
      <span className="stop-word">Stop robot</span>
      <span className="stop-hint" aria-hidden>
        {pending ? "not sent yet" : stopped ? "stopped, latched" : "Esc or Space"}
      </span>
    </button>
  );
}
