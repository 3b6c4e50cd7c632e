/** Ground that the robot must keep out of: drawn corner by corner on map or 3-D view, or by keys. */
import { Button } from "@mantine/core";
import { useHindrance } from "../console/control";
import { useDraft } from "../mission/draftStore";
import { sameAreas } from "./area";
import { canFinish, finishArea, startArea, undoCorner, useAreas } from "./areaStore";
import { sendAreas } from "./sharing";

export function ForbiddenAreas() {
  const state = useAreas();
  const { drawing } = state;
  const { draft, dispatch } = useDraft();
  const { areas } = draft;
  return (
    <div className="areas">
      <div className="button-row">
        {drawing === null ? (
          <Button size="xs" variant="default" onClick={startArea}>
            Forbid an area
          </Button>
        ) : (
          <>
            <Button size="xs" disabled={!canFinish(state)} onClick={finishArea}>
              Close area
            </Button>
            <Button size="xs" variant="default" onClick={undoCorner}>
              {drawing.length > 0 ? "Take back corner" : "Give up area"}
            </Button>
            <span className="hint" role="status">
              {drawing.length} {drawing.length === 1 ? "corner" : "corners"}: click the ground, or Enter on the map;
              three or more make an area.
            </span>
          </>
        )}
      </div>
      {areas.length > 0 && (
        <ul className="area-list" aria-label="Forbidden areas" role="list">
          {areas.map((area, index) => (
            <li key={index}>
              <span>
                Forbidden area {index + 1}, {area.length} corners
              </span>
              <Button
                size="compact-xs"
                variant="default"
                aria-label={`Delete area ${index + 1}`}
                onClick={() => dispatch({ type: "allow", index })}
              >
                Delete
              </Button>
            </li>
          ))}
        </ul>
      )}
      <Binding />
    </div>
  );
}

/** Whether the robot holds the areas as they are drawn. */
function Binding() {
  const onRobot = useAreas((state) => state.onRobot);
  const areas = useDraft((state) => state.draft.areas);
  const hindrance = useHindrance("set_areas");
  if (sameAreas(areas, onRobot)) {
    return areas.length === 0 ? null : (
      <p className="hint">The robot keeps out of them, also when it is driven by hand.</p>
    );
  }
  return (
    <div className="button-row">
      <span className="tag tag-caution">! Areas not on the robot</span>
      <Button
        size="compact-xs"
        variant="default"
        disabled={hindrance !== null}
        title={hindrance ?? undefined}
        onClick={() => void sendAreas()}
      >
        Send areas
      </Button>
    </div>
  );
}
