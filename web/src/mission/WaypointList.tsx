/** The waypoints as a list: the keyboard's way, and the exact one. */
import { latest, useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import { positionOf } from "../map/strokes";
import type { Waypoint } from "../protocol/messages";
import { useDraft } from "./draftStore";
import { WaypointRow } from "./WaypointRow";

export function WaypointList() {
  const { draft, dispatch } = useDraft();
  const mission = useLatest("state/mission");
  const running = mission?.phase === "active" || mission?.phase === "paused";
  return (
    <>
      {draft.waypoints.length > 0 && (
        <div className="waypoint waypoint-heads hint" aria-hidden>
          <span />
          <span>x, m</span>
          <span>y, m</span>
        </div>
      )}
      <ol className="waypoints" aria-label="Waypoints" role="list">
        {draft.waypoints.map((waypoint, index) => (
          <WaypointRow
            // Rows are places in the list: a moved waypoint shows its coordinates in another row.
            key={index}
            index={index}
            waypoint={waypoint}
            count={draft.waypoints.length}
            selected={draft.selected === index}
            next={running && mission.next_waypoint === index}
            dispatch={dispatch}
          />
        ))}
      </ol>
      {draft.waypoints.length === 0 && (
        <div className="empty">
          <p>No waypoints. Click on the terrain or the map to place one.</p>
          <button
            type="button"
            className="link-button"
            onClick={() => dispatch({ type: "add", waypoint: aheadOfRobot() })}
          >
            Add waypoint by coordinates
          </button>
        </div>
      )}
    </>
  );
}

/** A first place to edit from: a metre along x from the robot, or from the origin. */
function aheadOfRobot(): Waypoint {
  const position = latest(useConsole.getState(), "tele/state")?.value.position_in_world;
  const { x, y } = (position === undefined ? null : positionOf(position)) ?? { x: 0, y: 0 };
  return { x: x + 1, y };
}
