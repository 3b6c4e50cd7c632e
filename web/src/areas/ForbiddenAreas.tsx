/** Ground that missions must keep out of: drawn corner by corner on map or 3-D view, or by keys. */
import { Button } from "@mantine/core";
import { useDraft } from "../mission/draftStore";
import { canFinish, finishArea, startArea, undoCorner, useAreas } from "./areaStore";

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
    </div>
  );
}
