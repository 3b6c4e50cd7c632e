/** Both directions of the link apart: what arrives from the robot, and how long an answer takes. */
import { UNKNOWN, fixed, milliseconds, percent } from "../components/format";
import { spokenAge } from "../console/freshness";
import { useConsole } from "../console/store";

/** Seconds without a heartbeat after which the robot counts as silent. */
const SILENT_AFTER = 1;
const PONG_OVERDUE = 3;
const SLOW = 1;

export function LinkReadings() {
  const down = useConsole((state) => downlink(state.link?.heartbeat_age_s ?? null, state.linkReceived, state.now));
  const rate = useConsole((state) => fixed(state.link?.rates["tele/state"], 0));
  const loss = useConsole((state) => percent(state.link?.loss));
  const up = useConsole((state) => {
    if (state.connection !== "open" || state.roundTrip === null) return null;
    return (state.now - state.roundTripReceived) / 1000 > PONG_OVERDUE ? null : state.roundTrip;
  });
  const robotRoundTrip = useConsole((state) => state.commandRoundTrip);
  const open = useConsole((state) => state.connection === "open");
  const downLost = !open || down === null || down >= SILENT_AFTER;
  return (
    <dl className="link" aria-label="Link">
      <div data-bad={downLost} title="From the robot: age of its last heartbeat, states a second, heartbeats that did not arrive">
        <dt>
          <span aria-hidden>↓</span> robot
        </dt>
        <dd>
          {!open || down === null ? "none" : downLost ? `${spokenAge(down)} silent` : `${spokenAge(down)}, ${rate} Hz`}
          {!downLost && loss !== UNKNOWN && <span className="unit">, {loss} % lost</span>}
        </dd>
      </div>
      <div
        data-bad={up === null || up > SLOW}
        title="To the console and back, and to the robot and back for the last command"
      >
        <dt>
          <span aria-hidden>↑</span> console
        </dt>
        <dd>
          {up === null ? "none" : up > SLOW ? `${fixed(up, 1)} s, slow` : `${milliseconds(up)} ms`}
          {robotRoundTrip !== null && up !== null && (
            <span className="unit">, robot {milliseconds(robotRoundTrip)} ms</span>
          )}
        </dd>
      </div>
    </dl>
  );
}

/** Age of the heartbeat now, in tenths of a second: counted on from the console's last report. */
function downlink(age: number | null, received: number, now: number): number | null {
  return age === null ? null : Math.max(0, Math.round(10 * (age + Math.max(0, now - received - 500) / 1000)) / 10);
}
