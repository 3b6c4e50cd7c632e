/** The waypoints as a list: the keyboard's way, and the exact one. */
import { useLatest } from "../console/useLatest";
import { useDraft } from "./draftStore";
import { WaypointRow } from "./WaypointRow";

export function WaypointList() {
  const { draft, dispatch } = useDraft();
  const mission = useLatest("state/mission");
  const running = mission?.phase === "active" || mission?.phase === "paused";
  return (
    <>
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
          <button type="button" className="link-button" onClick={() => dispatch({ type: "add", waypoint: { x: 0, y: 0 } })}>
            Add waypoint by coordinates
          </button>
        </div>
      )}
    </>
  );
}
