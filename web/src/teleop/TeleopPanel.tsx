/** Driving by hand: hold the dead-man, steer with keys, pad or gamepad. Letting go stops the robot. */
import { useState } from "react";
import { Panel } from "../components/Panel";
import { Switch } from "../components/Switch";
import { fixed } from "../components/format";
import { holdsControl, selectedRobot } from "../console/control";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import { DrivePad } from "./DrivePad";
import { HoldButton } from "./HoldButton";
import { useTeleop } from "./useTeleop";

const SPEEDS = [0.25, 0.5, 0.75, 1];

export function TeleopPanel() {
  const hindrance = useDrivingHindrance();
  const [keyboard, setKeyboard] = useState(false);
  const [limit, setLimit] = useState(0.5);
  const enabled = hindrance === null;
  const teleop = useTeleop(enabled, keyboard, limit);
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
            <select value={limit} onChange={(event) => setLimit(Number(event.currentTarget.value))}>
              {SPEEDS.map((speed) => (
                <option key={speed} value={speed}>
                  {fixed(100 * speed, 0)} %
                </option>
              ))}
            </select>
          </label>
        </div>
      </div>
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
