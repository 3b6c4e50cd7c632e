/** Whether the ground ahead is judged robustly or exactly as published; what the robot reports is shown. */
import { Switch } from "../components/Switch";
import { command } from "../console/commands";
import { useHindrance } from "../console/control";
import { useFreshness, useLatest } from "../console/useLatest";

const KEY = "tele/adaptation";

const EXPLAINED = {
  "": "Nothing is heard of how the ground is judged.",
  robust: "The ground is judged robustly: outliers do not tilt its plane, the cameras' noise is taken off.",
  paper: "The ground is judged as published: plain least squares, the cameras' noise counts as roughness.",
};

export function PerceptionMode() {
  const mode = useLatest(KEY)?.perception ?? "";
  const { level } = useFreshness(KEY);
  const hindrance = useHindrance("set_perception");
  return (
    <div className="perception-mode" data-freshness={level} title={hindrance ?? undefined}>
      <Switch
        label="Paper mode"
        checked={mode === "paper"}
        disabled={hindrance !== null}
        onChange={(paper) => void command("set_perception", { name: paper ? "paper" : "robust" })}
      />
      <p className="hint">{EXPLAINED[level === "lost" || level === "never" ? "" : mode]}</p>
    </div>
  );
}
