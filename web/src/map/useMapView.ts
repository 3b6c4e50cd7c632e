/** Where the map looks: fits its element, follows the robot until it is moved by hand. */
import { type RefObject, useEffect, useRef, useState } from "react";
import { latest, useConsole } from "../console/store";
import { positionOf } from "./strokes";
import { type Point, type View, pan, zoomAt } from "./projection";

const FIRST_SCALE = 90; // px/m

export interface MapView {
  view: RefObject<View>;
  follow: boolean;
  pan(dx: number, dy: number): void;
  zoom(factor: number, at?: Point): void;
  centre(): void;
}

export function useMapView(element: RefObject<HTMLElement | null>): MapView {
  const view = useRef<View>({ x: 0, y: 0, scale: FIRST_SCALE, width: 1, height: 1 });
  const [follow, setFollow] = useState(true);

  useEffect(() => {
    const box = element.current;
    if (box === null) return;
    const observer = new ResizeObserver(() => {
      view.current = { ...view.current, width: Math.max(box.clientWidth, 1), height: Math.max(box.clientHeight, 1) };
    });
    observer.observe(box);
    return () => observer.disconnect();
  }, [element]);

  useEffect(() => {
    if (!follow) return;
    const look = () => {
      const position = latest(useConsole.getState(), "tele/state")?.value.position_in_world;
      const at = position === undefined ? null : positionOf(position);
      if (at !== null && (at.x !== view.current.x || at.y !== view.current.y))
        view.current = { ...view.current, ...at };
    };
    look();
    return useConsole.subscribe(look);
  }, [follow]);

  return {
    view,
    follow,
    pan(dx, dy) {
      setFollow(false);
      view.current = pan(view.current, dx, dy);
    },
    zoom(factor, at) {
      const { width, height } = view.current;
      view.current = zoomAt(view.current, follow || at === undefined ? { x: width / 2, y: height / 2 } : at, factor);
    },
    centre: () => setFollow(true),
  };
}
