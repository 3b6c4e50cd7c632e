/** Start, pause, skip, return and clear. Starting sends what the robot has not got yet. */
import { Button } from "@mantine/core";
import { CommandButton } from "../components/CommandButton";
import { command } from "../console/commands";
import { useHindrance } from "../console/control";
import { useLatest } from "../console/useLatest";
import { useDraft } from "./draftStore";

export function MissionButtons({ unsent }: { unsent: boolean }) {
  const { draft, dispatch } = useDraft();
  const mission = useLatest("state/mission");
  const sending = useHindrance("set_mission");
  const active = mission?.phase === "active";
  const empty = draft.waypoints.length === 0;

  const upload = async () => (await command("set_mission", { waypoints: draft.waypoints })).accepted;
  const start = async () => {
    // NOTE: a mission that was walked is sent again, the robot does not repeat one by itself.
    if ((!unsent && mission?.phase !== "done") || (await upload())) await command("start_mission");
  };
  const clear = () => {
    dispatch({ type: "clear" });
    if ((mission?.waypoints.length ?? 0) > 0 && sending === null) void command("clear_mission");
  };
  const hindrance = sending ?? (empty ? "place a waypoint first" : null);
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
      {sending !== null && !empty && <p className="hint">Not possible now: {sending}.</p>}
      {active && unsent && <p className="hint">Start mission sends the changes and goes on with them.</p>}
    </>
  );
}
