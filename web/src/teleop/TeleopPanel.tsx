/** Driving by hand: hold the dead-man, steer with keys, pad or gamepad. Letting go stops the robot. */
import { useState } from "react";
import { Panel } from "../components/Panel";
import { Switch } from "../components/Switch";
import { fixed, milliseconds } from "../components/format";
import { holdsControl, selectedRobot } from "../console/control";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import { DrivePad } from "./DrivePad";
import { HoldButton } from "./HoldButton";
import { allowedShare } from "./latency";
import { useTeleop } from "./useTeleop";

export function TeleopPanel() {
  const hindrance = useDrivingHindrance();
  const [keyboard, setKeyboard] = useState(false);
  const [limit, setLimit] = useState(0.5);
  const enabled = hindrance === null;
  const roundTrip = useConsole((state) => worstRoundTrip(state.roundTrip, state.commandRoundTrip));
  const share = allowedShare(roundTrip);
  const teleop = useTeleop(enabled, keyboard, limit * share);
  const driving = teleop.frame !== null;
  return (
    <Panel
      title="Drive by hand"
      className="teleop"
      aside={driving ? <span className="tag tag-caution">Driving</span> : undefined}
    >
      <div className="teleop-body">
        <DrivePad enabled={enabled} stick={teleop.frame} onMove={teleop.movePad} />
        <div className="teleop-side">
          <HoldButton enabled={enabled} onHold={teleop.hold} />
          <Switch label="Keyboard driving" checked={keyboard} disabled={!enabled} onChange={setKeyboard} />
          <label className="speed">
            <span>Speed limit</span>
            <input
              type="range"
              aria-label="Speed limit"
              aria-valuetext={`${fixed(100 * limit, 0)} %`}
              min={0.05}
              max={1}
              step={0.05}
              value={limit}
              onChange={(event) => setLimit(event.currentTarget.valueAsNumber)}
            />
            <span className="number">{fixed(100 * limit, 0)} %</span>
          </label>
        </div>
      </div>
      <p className="hint">
        Round trip {milliseconds(roundTrip)} ms
        {share < 1 && <strong>: speed reduced to {fixed(100 * share, 0)} %</strong>}
      </p>
      <p className="hint">
        {hindrance !== null
          ? `Not possible now: ${hindrance}.`
          : keyboard
            ? "Hold Shift or the button; W S A D walk, Q E or ← → turn."
            : `Drag the pad, or hold the button${teleop.gamepad === null ? "" : " (or a shoulder button of the gamepad)"}.`}
      </p>
    </Panel>
  );
}

/** Page to console, or to the robot where that took longer; null while unknown, s. */
function worstRoundTrip(toConsole: number | null, toRobot: number | null): number | null {
  return toConsole === null ? null : Math.max(toConsole, toRobot ?? 0);
}

function useDrivingHindrance(): string | null {
  const mode = useLatest("state/mode")?.mode;
  const state = useConsole((console) =>
    console.connection !== "open"
      ? "the console is unreachable"
      : selectedRobot(console)?.alive !== true
        ? "no live robot is selected"
        : holdsControl(console)
          ? null
          : "take control first",
  );
  if (state !== null) return state;
  return mode === "STAND" || mode === "WALK" || mode === "HOLD" ? null : "let the robot stand up first";
}
