/** How the ground shapes the gait, and where an operator steps in. */
import { NativeSelect } from "@mantine/core";
import { useState } from "react";
import { Panel } from "../components/Panel";
import { Reading } from "../components/Reading";
import { fixed } from "../components/format";
import { useLatest } from "../console/useLatest";
import { ParameterControl } from "./ParameterControl";
import { ADAPTED } from "./parameters";

const KEY = "tele/adaptation";
const DURATIONS = [
  { value: "60", label: "for 1 min" },
  { value: "300", label: "for 5 min" },
  { value: "1800", label: "for 30 min" },
  { value: "0", label: "until released" },
];

export function AdaptationPanel() {
  const report = useLatest(KEY);
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
      <div className="readings readings-pairs">
        <Reading label="Roughness" source={KEY} value={fixed(report?.roughness, 2)}>
          <Sigma value={report?.roughness_sigma} />
        </Reading>
        <Reading label="Step height" source={KEY} value={fixed(report?.step_height, 2)}>
          <Sigma value={report?.step_height_sigma} />
        </Reading>
        <Reading label="Roughness ahead" source={KEY} value={fixed(report?.ahead_roughness, 2)} />
        <Reading label="Step height ahead" source={KEY} value={fixed(report?.ahead_step_height, 2)} />
        <Reading label="Source" source={KEY} value={report?.source ?? ""} />
        <Reading label="Confidence" source={KEY} value={fixed(report?.desired.confidence, 2)} />
      </div>
      {ADAPTED.map((parameter) => (
        <ParameterControl key={parameter.name} parameter={parameter} seconds={Number(seconds)} />
      ))}
    </Panel>
  );
}

function Sigma({ value }: { value: number | null | undefined }) {
  return typeof value === "number" ? <span className="unit">± {fixed(value, 2)}</span> : null;
}
