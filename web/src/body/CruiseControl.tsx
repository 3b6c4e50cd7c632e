/** A velocity held for a while without a hand on the stick; any drive by hand, mission or stop ends it. */
import { NativeSelect } from "@mantine/core";
import { useState } from "react";
import { CommandButton } from "../components/CommandButton";
import { fixed } from "../components/format";
import { command } from "../console/commands";
import { selectedRobot, useHindrance } from "../console/control";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import { AxisSlider } from "./AxisSlider";
import { CRUISE_AXES } from "./axes";

const DURATIONS = [10, 30, 60, 300];

export function CruiseControl() {
  const orders = useLatest("state/motion");
  const robot = useConsole(selectedRobot)?.motion;
  const hindrance = useHindrance("start_cruise");
  const [seconds, setSeconds] = useState(30);
  const left = orders?.cruise_seconds_left ?? 0;
  const start = (name: string, value: number) => void command("start_cruise", { name, value, seconds });
  return (
    <div className="body-part" role="group" aria-label="Cruise">
      {CRUISE_AXES.map((axis, index) => (
        <AxisSlider
          key={axis.name}
          axis={axis}
          value={orders?.cruise_velocity[index] ?? null}
          largest={robot?.largest_cruise[index] ?? 0}
          disabled={hindrance !== null || robot === undefined}
          reason={hindrance}
          onChange={(value) => start(axis.name, value)}
        />
      ))}
      <div className="button-row">
        <NativeSelect
          aria-label="Cruise duration"
          size="xs"
          value={seconds}
          onChange={(event) => setSeconds(Number(event.currentTarget.value))}
        >
          {DURATIONS.map((duration) => (
            <option key={duration} value={duration}>
              for {duration} s
            </option>
          ))}
        </NativeSelect>
        <CommandButton name="start_cruise" size="xs" variant="default" onPress={() => start("stick", 0)}>
          Hold the stick's velocity
        </CommandButton>
        <CommandButton name="stop_cruise" size="xs" variant="default">
          Stop cruise
        </CommandButton>
        <span className="hint" role="status">
          {left > 0 ? `Cruising for another ${fixed(left, 0)} s` : ""}
        </span>
      </div>
    </div>
  );
}
