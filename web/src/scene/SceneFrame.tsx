/** The 3-D view in its frame. Without WebGL2 it would show nothing, so it is not loaded at all. */
import { useComputedColorScheme } from "@mantine/core";
import { useConsole } from "../console/store";

export function hasWebGl2(): boolean {
  return document.createElement("canvas").getContext("webgl2") !== null;
}

export function SceneFrame() {
  const address = useConsole((state) => state.hello?.scene ?? null);
  const dark = useComputedColorScheme("light") === "dark";
  if (address === null) return <p className="view-empty">Waiting for the 3-D view…</p>;
  return <iframe className="scene" title="3-D view" src={dark ? `${address}?darkMode` : address} />;
}
