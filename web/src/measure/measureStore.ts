/** Measuring between two places of the ground, chosen in the 3-D view or on the map. */
import { create } from "zustand";
import { send } from "../console/outbox";
import type { Waypoint } from "../protocol/messages";

interface Measure {
  /** The next places chosen are measured between, rather than waypoints. */
  active: boolean;
  places: readonly Waypoint[];
}

export const useMeasure = create<Measure>(() => ({ active: false, places: [] }));

/** Takes a place if something is being measured; a third one begins anew. */
export function measureAt({ x, y }: Waypoint): boolean {
  const { active, places } = useMeasure.getState();
  if (!active) return false;
  useMeasure.setState({ places: places.length === 1 ? [...places, { x, y }] : [{ x, y }] });
  publishMeasure();
  return true;
}

export function startMeasuring(active: boolean): void {
  useMeasure.setState({ active, places: [] });
  publishMeasure();
}

export function publishMeasure(): void {
  send({ type: "measure", places: useMeasure.getState().places });
}
