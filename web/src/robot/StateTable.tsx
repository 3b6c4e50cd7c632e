/** All states of the robot, what each means and what may be asked in it. Folded away; the status tells the present one. */
import { useLatest } from "../console/useLatest";
import type { Mode } from "../protocol/messages";
import { modeWords } from "../topbar/modes";

/** By the rules of the robot's command desk and mode machine (docs/messages.md, ModeState). */
const ALLOWS: Record<Mode, string> = {
  OFF: "Stand",
  READY: "Stand",
  STAND: "Sit, Start mission, driving, cruise, body and legs",
  WALK: "Sit, Pause mission, driving, cruise, body",
  SIT: "Stand",
  HOLD: "Sit; it goes on by itself when the reason is gone",
  FAULT: "Sit, and then Stand once the reason is gone",
  ESTOP: "Release stop, once it has settled",
};

export function StateTable() {
  const mode = useLatest("state/mode")?.mode;
  return (
    <details className="states">
      <summary>States</summary>
      <table className="loops" aria-label="States">
        <thead>
          <tr>
            <th scope="col">State</th>
            <th scope="col">Meaning</th>
            <th scope="col">What may be asked</th>
          </tr>
        </thead>
        <tbody>
          {Object.entries(ALLOWS).map(([state, allowed]) => (
            <tr key={state} aria-current={state === mode || undefined}>
              <th scope="row">
                {state === mode && "▸ "}
                {state}
              </th>
              <td>{modeWords(state)}</td>
              <td>{allowed}</td>
            </tr>
          ))}
        </tbody>
      </table>
      <p className="hint">Stop robot, the gait, missions and overrides are open in every state.</p>
    </details>
  );
}
