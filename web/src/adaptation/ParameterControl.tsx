/** One adapted parameter: what the gait uses, what the ground asks for, and the operator's override. */
import { Switch } from "../components/Switch";
import { Reading } from "../components/Reading";
import { fixed } from "../components/format";
import { useHindrance } from "../console/control";
import { useLatest } from "../console/useLatest";
import { CurvePlot } from "./CurvePlot";
import { ParameterPlot } from "./ParameterPlot";
import type { Parameter } from "./parameters";
import { useOverride } from "./useOverride";

const KEY = "tele/adaptation";

export function ParameterControl({ parameter, seconds }: { parameter: Parameter; seconds: number }) {
  const { name, label, unit, digits, lower, upper, step } = parameter;
  const report = useLatest(KEY);
  const hindrance = useHindrance("set_override");
  const override = useOverride(parameter, seconds);
  const applied = report?.applied[name];
  const shown = override.active ? (override.value ?? applied) : applied;
  const value = Math.min(Math.max(shown ?? lower, lower), upper);
  return (
    <div className="parameter" data-overridden={override.active}>
      <div className="parameter-head">
        <h3>{label}</h3>
        <span className="override-state">{override.active ? "held" : "automatic"}</span>
        <Switch
          shown="Override"
          label={`Override ${label}`}
          checked={override.active}
          disabled={hindrance !== null}
          onChange={override.toggle}
        />
      </div>
      <div className="parameter-body">
        <div className="readings">
          <Reading label="Current" source={KEY} value={fixed(applied, digits)} unit={unit} />
          <Reading label="Desired" source={KEY} value={fixed(report?.desired[name], digits)} unit={unit} />
        </div>
        <CurvePlot parameter={parameter} />
        <ParameterPlot parameter={parameter} />
      </div>
      <div className="slider">
        <span className="number">{fixed(lower, digits)}</span>
        <input
          type="range"
          aria-label={label}
          aria-valuetext={`${fixed(value, digits)} ${unit}`}
          min={lower}
          max={upper}
          step={step}
          value={value}
          disabled={!override.active || hindrance !== null}
          onChange={(event) => override.set(event.currentTarget.valueAsNumber)}
        />
        <span className="number">
          {fixed(upper, digits)} {unit}
        </span>
      </div>
    </div>
  );
}
