/** Which robot this page shows. Not changed while the robot walks under this page's control. */
import { NativeSelect } from "@mantine/core";
import { holdsControl, selectedRobot } from "../console/control";
import { selectRobot } from "../console/outbox";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import type { RobotEntry } from "../protocol/wire";
import { KIND_CLASS } from "./kinds";

export function RobotPicker() {
  const robots = useConsole((state) => state.robots);
  const robot = useConsole(selectedRobot);
  const walking = useLatest("state/mode")?.mode === "WALK";
  const held = useConsole(holdsControl);
  return (
    <div className="robot-picker">
      <NativeSelect
        aria-label="Robot"
        size="sm"
        value={robot?.id ?? ""}
        disabled={robots.length === 0 || (walking && held)}
        title={walking && held ? "The robot walks under your control: pause or stop it first" : undefined}
        onChange={(event) => selectRobot(event.currentTarget.value || null)}
      >
        <option value="">{robots.length === 0 ? "No robot yet" : "Choose a robot"}</option>
        {robots.map((entry) => (
          <option key={entry.id} value={entry.id}>
            {optionText(entry)}
          </option>
        ))}
      </NativeSelect>
      {robot !== undefined && <span className={`kind ${KIND_CLASS[robot.kind]}`}>{robot.kind}</span>}
    </div>
  );
}

function optionText(robot: RobotEntry): string {
  return `${robot.id} (${robot.kind}${robot.alive ? "" : ", silent"})`;
}
