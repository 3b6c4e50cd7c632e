/** Stops the robot on its keys, wherever the focus is, the 3-D view's frame included. */
import { useEffect } from "react";
import { stopRobot } from "../console/commands";
import { onSceneKey } from "../scene/sceneKeys";
import { isStopKey, isTextField } from "./keys";

export function useStopKeys(): void {
  useEffect(() => {
    const pressed = (event: KeyboardEvent) => {
      if (!isStopKey(event, isTextField(event.target))) return;
      event.preventDefault();
      if (!event.repeat) stopRobot();
    };
    // NOTE: a focused button is pressed by the release of Space, which must not follow a stop.
    const released = (event: KeyboardEvent) => {
      if (event.code === "Space" && !isTextField(event.target)) event.preventDefault();
    };
    window.addEventListener("keydown", pressed, { capture: true });
    window.addEventListener("keyup", released, { capture: true });
    const forget = onSceneKey((key) => {
      if (key.event === "keydown" && !key.repeat && isStopKey(key, false)) stopRobot();
    });
    return () => {
      window.removeEventListener("keydown", pressed, { capture: true });
      window.removeEventListener("keyup", released, { capture: true });
      forget();
    };
  }, []);
}
