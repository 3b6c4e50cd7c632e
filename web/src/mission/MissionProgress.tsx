/** How far the robot has come, by its own account. */
import { Reading } from "../components/Reading";
import { UNKNOWN, fixed } from "../components/format";
import { useLatest } from "../console/useLatest";
import type { MissionState } from "../protocol/messages";

const KEY = "state/mission";

const PHASES: Record<MissionState["phase"], string> = {
  empty: "none",
  ready: "ready to start",
  active: "under way",
  paused: "paused",
  done: "done",
};

export function MissionProgress() {
  const mission = useLatest(KEY);
  const way = mission?.phase === "empty" ? undefined : mission;
  return (
    <div className="readings">
      <Reading label="Mission on robot" source={KEY} value={mission === undefined ? UNKNOWN : described(mission)} />
      <Reading label="Distance left" source={KEY} value={fixed(way?.distance_left, 2)} unit="m" />
      <Reading label="Cross-track error" source={KEY} value={fixed(way?.cross_track_error, 2)} unit="m" />
    </div>
  );
}

function described({ phase, next_waypoint, waypoints }: MissionState): string {
  const running = phase === "active" || phase === "paused";
  return running ? `${PHASES[phase]}, waypoint ${next_waypoint + 1} of ${waypoints.length}` : PHASES[phase];
}
