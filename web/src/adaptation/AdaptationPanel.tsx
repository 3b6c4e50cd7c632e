/** How the ground shapes the gait, and where an operator steps in. */
import { NativeSelect } from "@mantine/core";
import { useState } from "react";
import { Panel } from "../components/Panel";
import { GroundReadings } from "./GroundReadings";
import { ParameterControl } from "./ParameterControl";
import { PerceptionMode } from "./PerceptionMode";
import { PresetPicker } from "./PresetPicker";
import { useParameters } from "./parameters";

const DURATIONS = [
  { value: "60", label: "for 1 min" },
  { value: "300", label: "for 5 min" },
  { value: "1800", label: "for 30 min" },
  { value: "3600", label: "for 1 h" },
];

export function AdaptationPanel() {
  const [seconds, setSeconds] = useState("300");
  return (
    <Panel
      title="Adaptation"
      role="group"
      className="adaptation"
      aside={
        <NativeSelect
          aria-label="Override lasts"
          size="xs"
          value={seconds}
          data={DURATIONS}
          onChange={(event) => setSeconds(event.currentTarget.value)}
        />
      }
    >
      <GroundReadings />
      <PresetPicker />
      <PerceptionMode />
      {useParameters().map((parameter) => (
        <ParameterControl key={parameter.name} parameter={parameter} seconds={Number(seconds)} />
      ))}
    </Panel>
  );
}
