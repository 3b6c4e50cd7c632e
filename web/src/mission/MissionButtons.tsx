/** Start, pause, skip, return and clear. Starting sends what the robot has not got yet. */
import { Button } from "@mantine/core";
import { forbiddenReason } from "../areas/geometry";
import { sendAreas } from "../areas/sharing";
import { CommandButton } from "../components/CommandButton";
import { command } from "../console/commands";
import { selectedRobot, useHindrance } from "../console/control";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import { positionOf } from "../map/strokes";
import { useDraft } from "./draftStore";

/** Why the edited way is refused here already; the robot judges for itself once more. */
function useForbidden(): string | null {
  const waypoints = useDraft((state) => state.draft.waypoints);
  const areas = useDraft((state) => state.draft.areas);
  const halfWidth = useConsole((state) => selectedRobot(state)?.motion?.half_width ?? 0);
  const mission = useLatest("state/mission");
  const position = useLatest("tele/state")?.position_in_world;
  if (areas.length === 0 || waypoints.length === 0) return null;
  const running = mission?.phase === "active" || mission?.phase === "paused";
  const ahead = running ? waypoints.slice(mission.next_waypoint) : waypoints;
  const start = position === undefined ? null : positionOf(position);
  const skipped = waypoints.length - ahead.length;
  const reason = forbiddenReason(start, ahead, areas, halfWidth);
  return skipped > 0 && reason !== null
    ? reason.replace(/waypoint (\d+)/, (_, number) => `waypoint ${Number(number) + skipped}`)
    : reason;
}

export function MissionButtons({ unsent }: { unsent: boolean }) {
  const { draft, dispatch } = useDraft();
  const mission = useLatest("state/mission");
  const sending = useHindrance("set_mission");
  const active = mission?.phase === "active";
  const empty = draft.waypoints.length === 0;

  // The areas first, so that the robot judges the mission by them.
  const upload = async () =>
    (await sendAreas()) && (await command("set_mission", { waypoints: draft.waypoints })).accepted;
  const start = async () => {
    // NOTE: a mission that was walked is sent again, the robot does not repeat one by itself.
    if ((!unsent && mission?.phase !== "done") || (await upload())) await command("start_mission");
  };
  const clear = () => {
    dispatch({ type: "clear" });
    if ((mission?.waypoints.length ?? 0) > 0 && sending === null) void command("clear_mission");
  };
  const forbidden = useForbidden();
  const hindrance = sending ?? (empty ? "place a waypoint first" : forbidden);
  return (
    <>
      <Button size="xs" variant="default" disabled={empty && (mission?.waypoints.length ?? 0) === 0} onClick={clear}>
        Clear waypoints
      </Button>
      <span className="break" />
      <Button
        disabled={hindrance !== null || (active && !unsent)}
        title={hindrance ?? undefined}
        onClick={() => void start()}
        className="grow"
      >
        Start mission
      </Button>
      <CommandButton name="pause_mission" variant="default" className="grow">
        Pause mission
      </CommandButton>
      <span className="break" />
      <CommandButton name="skip_waypoint" variant="default" size="xs" className="grow">
        Skip waypoint
      </CommandButton>
      <CommandButton name="return_to_start" variant="default" size="xs" className="grow">
        Return to start
      </CommandButton>
      {forbidden !== null && <p className="tag tag-caution">Refused: {forbidden}.</p>}
      {sending !== null && !empty && <p className="hint">Not possible now: {sending}.</p>}
      {active && unsent && <p className="hint">Start mission sends the changes and goes on with them.</p>}
    </>
  );
}
