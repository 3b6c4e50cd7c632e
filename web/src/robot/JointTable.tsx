/** Every joint with its angle within its limits and its torque. Folded away: thirty rows are for a closer look. */
import { useState } from "react";
import { UNKNOWN, degrees, fixed } from "../components/format";
import { selectedRobot } from "../console/control";
import { useConsole } from "../console/store";
import { useFreshness, useLatest } from "../console/useLatest";

const KEY = "tele/state";
/** Closer to a limit than this a joint is marked, rad. */
const CLOSE = 0.05;

export function JointTable() {
  const [open, setOpen] = useState(false);
  return (
    <details className="joints" onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>Joints</summary>
      {open && <Rows />}
    </details>
  );
}

function Rows() {
  const robot = useConsole(selectedRobot);
  const state = useLatest(KEY);
  const { level } = useFreshness(KEY);
  const gone = level === "lost" || level === "never";
  return (
    <table className="loops" data-freshness={level}>
      <thead>
        <tr>
          <th scope="col">Joint</th>
          <th scope="col">Angle, °</th>
          <th scope="col">Limits, °</th>
          <th scope="col">Torque, N m</th>
        </tr>
      </thead>
      <tbody>
        {(robot?.joint_names ?? []).map((name, index) => {
          const angle = state?.joint_position[index] ?? null;
          const [lower, upper] = robot?.joint_limits[index] ?? [NaN, NaN];
          const close = angle !== null && (angle < lower + CLOSE || angle > upper - CLOSE);
          return (
            <tr key={name}>
              <th scope="row">{name}</th>
              <td>
                {gone ? UNKNOWN : degrees(angle)}
                {close && !gone && " at its limit"}
              </td>
              <td>
                {degrees(lower, 0)} to {degrees(upper, 0)}
              </td>
              <td>{gone ? UNKNOWN : fixed(state?.joint_torque[index], 1)}</td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}
