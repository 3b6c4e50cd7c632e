/** Gives a canvas as many pixels as it covers. Observed rather than measured: reading a size while drawing lays out the page. */
import { type RefObject, useEffect } from "react";

export function useCanvasSize(canvas: RefObject<HTMLCanvasElement | null>, height: number): void {
  useEffect(() => {
    const element = canvas.current;
    if (element === null) return;
    const observer = new ResizeObserver(([entry]) => {
      if (entry !== undefined) element.width = Math.round(entry.contentRect.width * devicePixelRatio);
    });
    element.height = Math.round(height * devicePixelRatio);
    observer.observe(element);
    return () => observer.disconnect();
  }, [canvas, height]);
}
