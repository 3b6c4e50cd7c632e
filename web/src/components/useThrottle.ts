/** Runs the newest of the actions it is given, at most one a period. */
import { useEffect, useRef } from "react";

/** `period` in ms. */
export function useThrottle(period: number): (action: () => void) => void {
  const newest = useRef<(() => void) | null>(null);
  const timer = useRef<ReturnType<typeof setTimeout> | undefined>(undefined);
  useEffect(() => () => clearTimeout(timer.current), []);
  return (action) => {
    newest.current = action;
    timer.current ??= setTimeout(() => {
      timer.current = undefined;
      newest.current?.();
    }, period);
  };
}
