/** Editing, sending and watching a mission. */
import { Button } from "@mantine/core";
import { ForbiddenAreas } from "../areas/ForbiddenAreas";
import { sameAreas } from "../areas/area";
import { useAreas } from "../areas/areaStore";
import { Panel } from "../components/Panel";
import { fixed } from "../components/format";
import { useLatest } from "../console/useLatest";
import { positionOf } from "../map/strokes";
import { useDraft } from "./draftStore";
import { MissionButtons } from "./MissionButtons";
import { MissionOutlook } from "./MissionOutlook";
import { MissionProgress } from "./MissionProgress";
import { pathLength } from "./path";
import { SavedMissions } from "./SavedMissions";
import { WaypointList } from "./WaypointList";
import { sameWaypoints } from "./waypoints";

export function MissionPanel() {
  const { draft, dispatch } = useDraft();
  const onRobot = useLatest("state/mission")?.waypoints;
  const start = useLatest("tele/state")?.position_in_world;
  const areasOnRobot = useAreas((state) => state.onRobot);
  const unsent = !sameWaypoints(draft.waypoints, onRobot ?? []) || !sameAreas(draft.areas, areasOnRobot);
  const length = pathLength(draft.waypoints, start === undefined ? null : positionOf(start));
  return (
    <Panel
      title="Mission"
      className="mission"
      aside={
        <span className="panel-aside">
          {unsent && <span className="tag tag-caution">! Unsent changes</span>}
          {draft.waypoints.length > 0 && <span className="number">{fixed(length, 2)} m</span>}
        </span>
      }
    >
      <WaypointList />
      <ForbiddenAreas />
      <div className="button-row">
        <Button
          size="xs"
          variant="default"
          disabled={draft.past.length === 0}
          onClick={() => dispatch({ type: "undo" })}
        >
          Undo
        </Button>
        <Button
          size="xs"
          variant="default"
          disabled={draft.future.length === 0}
          onClick={() => dispatch({ type: "redo" })}
        >
          Redo
        </Button>
        <MissionButtons unsent={unsent} />
      </div>
      <MissionProgress />
      <MissionOutlook edited={draft.waypoints.length > 0 ? length : null} unsent={unsent} />
      <SavedMissions />
    </Panel>
  );
}
