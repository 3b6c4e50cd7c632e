/** State of the robot with the reasons that hold it, each of which vanishes when it is fixed. */
import { spokenAge } from "../console/freshness";
import { selectedRobot } from "../console/control";
import { useConsole } from "../console/store";
import { useFreshness, useLatest } from "../console/useLatest";
import type { ModeState } from "../protocol/messages";
import { modeTone, modeWords } from "./modes";

interface Status {
  tone: string;
  state: string;
  words: string;
  reasons: readonly string[];
}

export function StatusPill() {
  const status = useStatus();
  return (
    <div className="status" role="status" aria-label="Robot status" data-tone={status.tone}>
      <span className="status-state">{status.state}</span>
      <span className="status-words">
        {status.words}
        {status.reasons.length > 0 && <span className="status-reasons">{status.reasons.join("; ")}</span>}
      </span>
    </div>
  );
}

function useStatus(): Status {
  const connection = useConsole((state) => state.connection);
  const robot = useConsole(selectedRobot);
  const none = useConsole((state) => state.robots.length === 0);
  const mode = useLatest("state/mode");
  const { level, age } = useFreshness("state/mode");
  if (connection === "connecting") return quiet("CONNECTING", "looking for the console");
  if (connection !== "open") return { tone: "danger", state: "NO LINK", words: "console unreachable", reasons: [] };
  if (robot === undefined) return quiet("NO ROBOT", none ? "waiting for one to appear" : "choose one");
  if (!robot.alive || level === "lost") {
    const silence = mode === undefined ? "no state heard" : `last heard ${spokenAge(age)} ago as ${mode.mode}`;
    return { tone: "danger", state: "LOST", words: "robot silent", reasons: [silence] };
  }
  if (mode === undefined) return quiet("WAITING", "no state from the robot yet");
  return { ...described(mode), ...(level === "stale" ? { tone: "stale", words: `${spokenAge(age)} old` } : {}) };
}

function described(mode: ModeState): Status {
  const reasons = mode.stopped
    ? [`stop latched${mode.stop_level === "" ? "" : ` (${mode.stop_level})`}`, ...mode.reasons]
    : mode.reasons;
  return { tone: modeTone(mode), state: mode.mode, words: modeWords(mode.mode), reasons };
}

function quiet(state: string, words: string): Status {
  return { tone: "quiet", state, words, reasons: [] };
}
