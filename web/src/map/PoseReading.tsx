/** Where the robot is and where it looks, in numbers. */
import { Reading } from "../components/Reading";
import { UNKNOWN, degrees, fixed } from "../components/format";
import { useLatest } from "../console/useLatest";
import { yawOf } from "./projection";

const KEY = "tele/state";

export function PoseReading() {
  const state = useLatest(KEY);
  const [x, y] = state?.position_in_world ?? [];
  return (
    <div className="map-pose">
      <Reading label="x" source={KEY} value={fixed(x, 2)} unit="m" />
      <Reading label="y" source={KEY} value={fixed(y, 2)} unit="m" />
      <Reading label="heading" source={KEY} value={state === undefined ? UNKNOWN : heading(state.wxyz)} unit="°" />
    </div>
  );
}

/** From the x axis, positive to the left. */
function heading(wxyz: readonly (number | null)[]): string {
  const [w, x, y, z] = wxyz.map((part) => part ?? NaN);
  return degrees(yawOf([w ?? NaN, x ?? NaN, y ?? NaN, z ?? NaN]), 0);
}
