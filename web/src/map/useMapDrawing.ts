/** Draws the map whenever something on it changed, at the screen's resolution, and at its pace under a hand. */
import { useComputedColorScheme } from "@mantine/core";
import { type RefObject, useEffect, useMemo } from "react";
import { useAreas } from "../areas/areaStore";
import { freshnessOf } from "../console/useLatest";
import { terrain } from "../console/live";
import { usePreferences } from "../console/preferences";
import { selectedRobot } from "../console/control";
import { latest, useConsole } from "../console/store";
import { shownWaypoints, useDraft } from "../mission/draftStore";
import { useMeasure } from "../measure/measureStore";
import { type ColourScale, colourScale } from "./colourScale";
import type { Ink } from "./strokes";
import type { View } from "./projection";
import { renderMap } from "./render";
import { TilePainter } from "./tilePainter";

const LOOK_PERIOD = 60; // ms

export const INKS: Record<"light" | "dark", Ink> = {
  light: {
    ground: "#e9edf1",
    hatch: "#d3dae1",
    grid: "rgba(20, 30, 40, 0.16)",
    text: "#10202c",
    halo: "#ffffff",
    path: "#8a1c6b",
    trail: "#44525f",
    robot: "#075a70",
    truth: "#a04000",
    forbidden: "#b3131f",
  },
  dark: {
    ground: "#1a222b",
    hatch: "#2a3540",
    grid: "rgba(220, 235, 250, 0.14)",
    text: "#eef4f8",
    halo: "#0c1116",
    path: "#ff8ad8",
    trail: "#c2ccd6",
    robot: "#5fd3ef",
    truth: "#ffb35c",
    forbidden: "#ff6b6b",
  },
};

export function useMapDrawing(
  canvas: RefObject<HTMLCanvasElement | null>,
  view: RefObject<View>,
  crossHair: boolean,
): void {
  const ink = INKS[useComputedColorScheme("light")];
  const legend = useConsole((state) => state.legend);
  const scale = useMemo<ColourScale | null>(() => (legend === null ? null : colourScale(legend)), [legend]);

  useEffect(() => {
    const context = canvas.current?.getContext("2d") ?? null;
    if (context === null) return;
    const painter = new TilePainter();
    let drawn: readonly unknown[] = [];
    let frame = 0;
    const look = () => {
      frame = 0;
      const state = useConsole.getState();
      const { draft, dragging } = useDraft.getState();
      const robot = latest(state, "tele/state")?.value;
      const { level } = freshnessOf(state, "tele/state");
      const mission = latest(state, "state/mission")?.value;
      const truth = usePreferences.getState().view.truth ? latest(state, "truth/state")?.value : undefined;
      const { view: options } = usePreferences.getState();
      const contours = options.contours;
      const measure = useMeasure.getState().places;
      const { drawing } = useAreas.getState();
      const halfWidth = selectedRobot(state)?.motion?.half_width ?? 0;
      const shown = [
        view.current,
        draft,
        dragging,
        robot,
        level,
        mission,
        truth,
        contours,
        measure,
        drawing,
        halfWidth,
        terrain.version,
        devicePixelRatio,
      ];
      if (shown.every((part, k) => part === drawn[k])) return;
      drawn = shown;
      fit(context, view.current);
      const waypoints = shownWaypoints({ draft, dragging });
      const selected = draft.selected;
      renderMap(context, painter, {
        view: view.current,
        scale,
        waypoints,
        selected,
        radii: { passing: state.hello?.passing_radius_m ?? 0, goal: state.hello?.goal_radius_m ?? 0 },
        state: robot,
        level,
        mission,
        truth,
        crossHair,
        contours,
        halfWidth,
        measure,
        areas: draft.areas,
        drawing,
        ink,
      });
    };
    // Looking costs next to nothing, asking the browser for a picture 60 times a second does: only a hand needs that.
    const soon = () => (frame ||= requestAnimationFrame(look));
    const timer = setInterval(look, LOOK_PERIOD);
    const hand = ["pointermove", "pointerdown", "pointerup", "wheel", "keydown"] as const;
    for (const kind of hand) context.canvas.parentElement?.addEventListener(kind, soon, { passive: true });
    look();
    return () => {
      clearInterval(timer);
      cancelAnimationFrame(frame);
      for (const kind of hand) context.canvas.parentElement?.removeEventListener(kind, soon);
    };
  }, [canvas, view, scale, ink, crossHair]);
}

function fit(context: CanvasRenderingContext2D, view: View): void {
  const { canvas } = context;
  const ratio = devicePixelRatio;
  const [width, height] = [Math.round(view.width * ratio), Math.round(view.height * ratio)];
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
}
