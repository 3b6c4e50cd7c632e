/** Where the body is held against where walking alone carries it. */
import { Button } from "@mantine/core";
import { Switch } from "../components/Switch";
import { command } from "../console/commands";
import { selectedRobot, useHindrance } from "../console/control";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import { AxisSlider } from "./AxisSlider";
import { POSE_AXES } from "./axes";

export function PoseSliders() {
  const orders = useLatest("state/motion");
  const largest = useConsole(selectedRobot)?.motion?.largest_pose;
  const hindrance = useHindrance("set_pose");
  const enabled = hindrance === null && orders !== undefined;
  return (
    <div className="body-part" role="group" aria-label="Body pose">
      {POSE_AXES.map((axis, index) => (
        <AxisSlider
          key={axis.name}
          axis={axis}
          value={orders?.pose[index] ?? null}
          largest={largest?.[index] ?? 0}
          disabled={!enabled || largest === undefined}
          reason={hindrance}
          onChange={(value) => void command("set_pose", { name: axis.name, value })}
        />
      ))}
      <div className="button-row">
        <Switch
          label="Level by the IMU"
          checked={orders?.levelling ?? false}
          disabled={!enabled}
          onChange={(on) => void command("set_posing", { name: "levelling", value: on ? 1 : 0 })}
        />
        <Switch
          label="Sway with the gait"
          checked={orders?.automatic_posing ?? false}
          disabled={!enabled}
          onChange={(on) => void command("set_posing", { name: "automatic", value: on ? 1 : 0 })}
        />
        <Button
          size="xs"
          variant="default"
          disabled={!enabled}
          title={hindrance ?? undefined}
          onClick={() => void command("clear_pose")}
        >
          Clear pose
        </Button>
      </div>
    </div>
  );
}
