/** What the adaptation takes the ground for: indices from 0 (flat) to 1, under the body and ahead. */
import { Reading } from "../components/Reading";
import { UNKNOWN, fixed } from "../components/format";
import { useLatest } from "../console/useLatest";
import { LookClosely } from "./LookClosely";

const KEY = "tele/adaptation";

export function GroundReadings() {
  const report = useLatest(KEY);
  return (
    <div className="readings">
      <Reading label="Roughness, 0–1" source={KEY} value={fixed(report?.roughness, 2)}>
        <Sigma value={report?.roughness_sigma} />
        <Ahead value={report?.ahead_roughness} />
      </Reading>
      <Reading label="Step height, 0–1" source={KEY} value={fixed(report?.step_height, 2)}>
        <Sigma value={report?.step_height_sigma} />
        <Ahead value={report?.ahead_step_height} />
      </Reading>
      <Reading label="Source" source={KEY} value={report?.source ?? UNKNOWN}>
        <span className="unit">confidence {fixed(report?.desired.confidence, 2)}</span>
      </Reading>
      <LookClosely />
    </div>
  );
}

function Sigma({ value }: { value: number | null | undefined }) {
  return typeof value === "number" ? <span className="unit">± {fixed(value, 2)}</span> : null;
}

function Ahead({ value }: { value: number | null | undefined }) {
  return <span className="unit">(ahead {fixed(value, 2)})</span>;
}
