/** The 3-D view in its frame. It lives in the console; this page only says how to draw it. */
import { useComputedColorScheme } from "@mantine/core";
import { useConsole } from "../console/store";

/** `coarse`: half the pixels in each direction. */
export function SceneFrame({ coarse }: { coarse: boolean }) {
  const address = useConsole((state) => state.hello?.scene ?? null);
  const dark = useComputedColorScheme("light") === "dark";
  if (address === null) return <p className="view-empty">Waiting for the 3-D view…</p>;
  const options = [...(dark ? ["darkMode"] : []), ...(coarse ? ["fixedDpr=0.5"] : [])].join("&");
  const source = options === "" ? address : `${address}?${options}`;
  // Without an origin of its own the frame gets a process of its own: drawing never holds up Stop and the lease.
  return <iframe className="scene" title="3-D view" sandbox="allow-scripts allow-pointer-lock" src={source} />;
}
