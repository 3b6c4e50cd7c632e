/** What this browser likes to see; kept for the next load. */
import { create } from "zustand";
import { persist } from "zustand/middleware";
import type { LayerName } from "../map/tiles";

export type MainView = "scene" | "map" | "camera";

interface Preferences {
  layer: LayerName;
  /** The large picture; the others are small beside it. */
  mainView: MainView;
  cameras: boolean;
  camera: string | null;
  view: { follow: boolean; truth: boolean; frusta: boolean; trail: boolean };
}

export const usePreferences = create<Preferences>()(
  persist(
    (): Preferences => ({
      layer: "elevation",
      mainView: "scene",
      cameras: true,
      camera: null,
      view: { follow: true, truth: false, frusta: false, trail: true },
    }),
    { name: "weaver.preferences", version: 1 },
  ),
);
