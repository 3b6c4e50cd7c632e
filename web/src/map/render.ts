/** The whole picture of the 2-D map, back to front. */
import type { Area } from "../areas/area";
import { terrain, history } from "../console/live";
import type { Freshness } from "../console/freshness";
import type { MissionState, RobotState, TruthState, Waypoint } from "../protocol/messages";
import type { ColourScale } from "./colourScale";
import { drawGrid, drawUnknownGround } from "./ground";
import { drawAreas } from "./areaMarks";
import { drawMeasure } from "./measureMarks";
import { drawCorridor, drawLookahead, drawPath, drawTrail, drawWaypoint } from "./missionMarks";
import { drawRobot, drawTruth } from "./robotMark";
import { type Ink, positionOf } from "./strokes";
import { drawAxes, drawCrossHair, drawScaleBar } from "./furniture";
import { type View, toScreen } from "./projection";
import type { TilePainter } from "./tilePainter";

export interface Scene {
  view: View;
  scale: ColourScale | null;
  waypoints: readonly Waypoint[];
  selected: number | null;
  /** Distances at which a waypoint counts as passed, and the last one as reached, m. */
  radii: { passing: number; goal: number };
  state: RobotState | undefined;
  level: Freshness["level"];
  mission: MissionState | undefined;
  truth: TruthState | undefined;
  /** The map has the keyboard: its middle is where Enter puts a waypoint. */
  crossHair: boolean;
  contours: boolean;
  /** How far beside the way feet are expected, m. */
  halfWidth: number;
  measure: readonly Waypoint[];
  areas: readonly Area[];
  drawing: Area | null;
  ink: Ink;
}

export function renderMap(context: CanvasRenderingContext2D, painter: TilePainter, scene: Scene): void {
  const { view, ink, state, mission } = scene;
  drawUnknownGround(context, view, ink);
  if (scene.scale !== null) drawTerrain(context, painter, view, scene.scale, scene.contours);
  drawGrid(context, view, ink);
  drawAreas(context, view, scene.areas, scene.drawing, ink);
  drawTrail(context, view, history.trail, ink);
  const robot = state === undefined ? null : positionOf(state.position_in_world);
  const running = mission?.phase === "active" || mission?.phase === "paused";
  const next = running ? mission.next_waypoint : 0;
  drawCorridor(context, view, robot, scene.waypoints.slice(next), scene.halfWidth, ink);
  drawPath(context, view, robot, scene.waypoints.slice(next), ink);
  const lookahead = mission?.phase === "active" ? positionOf(mission.lookahead_in_world) : null;
  if (robot !== null && lookahead !== null) drawLookahead(context, view, robot, lookahead, ink);
  scene.waypoints.forEach((waypoint, index) => {
    const reached = mission?.phase === "done" || (running && index < next);
    const mark = {
      waypoint,
      number: index + 1,
      selected: index === scene.selected,
      reached,
      radius: index === scene.waypoints.length - 1 ? scene.radii.goal : scene.radii.passing,
    };
    drawWaypoint(context, view, mark, ink);
  });
  const truth = scene.truth === undefined ? null : positionOf(scene.truth.position_in_world);
  if (truth !== null) drawTruth(context, view, truth, ink);
  if (state !== undefined) drawRobot(context, view, state, scene.level !== "live", ink);
  drawMeasure(context, view, scene.measure, ink);
  drawScaleBar(context, view, ink);
  drawAxes(context, view, ink);
  if (scene.crossHair) drawCrossHair(context, view, ink);
}

function drawTerrain(
  context: CanvasRenderingContext2D,
  painter: TilePainter,
  view: View,
  scale: ColourScale,
  contours: boolean,
): void {
  context.imageSmoothingEnabled = false;
  for (const [key, tile] of terrain.tiles) {
    const edge = tile.size * tile.cell;
    const corner = toScreen(view, { x: tile.i * edge, y: (tile.j + 1) * edge });
    const pixels = edge * view.scale;
    if (corner.x > view.width || corner.y > view.height || corner.x + pixels < 0 || corner.y + pixels < 0) continue;
    context.drawImage(painter.picture(key, tile, scale, contours), corner.x, corner.y, pixels + 0.5, pixels + 0.5);
  }
}
