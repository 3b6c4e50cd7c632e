/** The 2-D map: exact mission editor, and the whole picture where there is no WebGL. */
import { useEffect, useId, useRef, useState } from "react";
import { useDraft } from "../mission/draftStore";
import { MAP_HELP } from "./keys";
import { addWaypoint, useMapKeys } from "./useMapKeys";
import { listenToPointer } from "./pointer";
import { type Point, toScreen, toWorld } from "./projection";
import { useMapDrawing } from "./useMapDrawing";
import { useMapView } from "./useMapView";
import { MapTools } from "./MapTools";
import { PoseReading } from "./PoseReading";

/** Pixels around a waypoint that count as on it; a finger needs room. */
const REACH = 20;

export function MapCanvas() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const box = useRef<HTMLDivElement>(null);
  const help = useId();
  const [focused, setFocused] = useState(false);
  const map = useMapView(box);
  useMapDrawing(canvas, map.view, focused);

  const actions = useRef(map);
  actions.current = map;
  useEffect(() => {
    if (canvas.current === null) return;
    const { dispatch, drag } = useDraft.getState();
    const world = (screen: Point) => toWorld(actions.current.view.current, screen);
    return listenToPointer(canvas.current, {
      waypointAt: (screen) => waypointAt(screen, (point) => toScreen(actions.current.view.current, point)),
      add: (screen, insert) => addWaypoint(world(screen), insert),
      select: (index) => dispatch({ type: "select", index }),
      remove: (index) => dispatch({ type: "delete", index }),
      drag: (index, screen, done) => drag(index, world(screen), done),
      pan: (dx, dy) => actions.current.pan(dx, dy),
      zoom: (screen, factor) => actions.current.zoom(factor, screen),
    });
  }, []);

  const press = useMapKeys(map);

  return (
    <div className="map" ref={box}>
      <canvas
        ref={canvas}
        role="application"
        aria-label="Map"
        aria-describedby={help}
        tabIndex={0}
        onKeyDown={press}
        onFocus={(event) => setFocused(event.currentTarget.matches(":focus-visible"))}
        onBlur={() => setFocused(false)}
      />
      <p id={help} className="visually-hidden">
        {MAP_HELP}
      </p>
      <MapTools map={map} />
      <PoseReading />
    </div>
  );
}

function waypointAt(screen: Point, project: (point: Point) => Point): number | null {
  const { waypoints } = useDraft.getState().draft;
  let best: number | null = null;
  let least = REACH;
  waypoints.forEach((waypoint, index) => {
    const at = project(waypoint);
    const gap = Math.hypot(at.x - screen.x, at.y - screen.y);
    if (gap < least) [best, least] = [index, gap];
  });
  return best;
}
