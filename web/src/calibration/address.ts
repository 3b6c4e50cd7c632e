/** Which of the console's pages is shown: by the address, so that it can be linked to and left with Back. */
import { useSyncExternalStore } from "react";

export const CALIBRATION = "#calibration";

export function useAddress(): string {
  return useSyncExternalStore(
    (changed) => {
      window.addEventListener("hashchange", changed);
      return () => window.removeEventListener("hashchange", changed);
    },
    () => window.location.hash,
  );
}
