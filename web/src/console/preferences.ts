/** What this browser likes to see; kept for the next load. */
import { create } from "zustand";
import { persist } from "zustand/middleware";
import type { LayerName } from "../map/tiles";

export type MainView = "scene" | "map" | "camera";

interface Preferences {
  layer: LayerName;
  /** The large picture; the others are small beside it. */
  mainView: MainView;
  /** Draw the odometry's features over the cameras' pictures. */
  features: boolean;
  camera: string | null;
  view: { follow: boolean; truth: boolean; frusta: boolean; trail: boolean; contours: boolean; torques: boolean };
}

export const usePreferences = create<Preferences>()(
  persist(
    (): Preferences => ({
      layer: "elevation",
      mainView: "scene",
      features: false,
      camera: null,
      view: { follow: true, truth: false, frusta: false, trail: true, contours: false, torques: false },
    }),
    {
      name: "weaver.preferences",
      version: 1,
      // What was kept before an option came keeps its meaning.
      merge: (kept, now) => ({ ...now, ...(kept as object), view: { ...now.view, ...(kept as Preferences | undefined)?.view } }),
    },
  ),
);
