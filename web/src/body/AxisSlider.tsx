/** A slider for one axis: at once where the operator drags it, then where the robot says it is. */
import { useEffect, useState } from "react";
import { fixed } from "../components/format";
import { useThrottle } from "../components/useThrottle";
import { type Axis, robotValue, shownValue } from "./axes";

/** How long the operator's wish is shown while the robot has not reported it yet, ms. */
const PATIENCE = 1500;
/** A slider under way is sent this often at most, ms. */
const SEND_PERIOD = 120;

interface AxisSliderProps {
  axis: Axis;
  /** What the robot holds, in its own unit; null when unknown. */
  value: number | null;
  /** Largest amount either way, in the robot's unit. */
  largest: number;
  disabled: boolean;
  reason: string | null;
  onChange(value: number): void;
}

export function AxisSlider({ axis, value, largest, disabled, reason, onChange }: AxisSliderProps) {
  const [wish, setWish] = useState<number | null>(null);
  const send = useThrottle(SEND_PERIOD);
  const most = shownValue(axis, largest);
  const shown = wish ?? shownValue(axis, value ?? 0);

  useEffect(() => {
    if (wish === null) return;
    const timer = setTimeout(() => setWish(null), PATIENCE);
    return () => clearTimeout(timer);
  }, [wish]);

  return (
    <label className="axis-slider" title={reason ?? undefined}>
      <span>{axis.label}</span>
      <input
        type="range"
        aria-label={axis.label}
        aria-valuetext={`${fixed(shown, axis.digits)} ${axis.unit}`}
        min={-most}
        max={most}
        step={axis.step}
        value={shown}
        disabled={disabled}
        onChange={(event) => {
          const wanted = event.currentTarget.valueAsNumber;
          setWish(wanted);
          send(() => onChange(robotValue(axis, wanted)));
        }}
      />
      <span className="number">
        {value === null && wish === null ? fixed(null, 0) : fixed(shown, axis.digits)}
        <span className="unit"> {axis.unit}</span>
      </span>
    </label>
  );
}
