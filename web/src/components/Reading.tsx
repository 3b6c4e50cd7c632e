/** One value of the robot with its unit: live, stale (grey, with its age) or lost (a dash). */
import type { ReactNode } from "react";
import { spokenAge } from "../console/freshness";
import { useFreshness } from "../console/useLatest";
import { UNKNOWN } from "./format";

interface ReadingProps {
  label: string;
  /** Key of the message the value is from. */
  source: string;
  value: string;
  unit?: string;
  /** What stands behind the value: a bar, a sigma. */
  children?: ReactNode;
  /** Shows the label to screen readers only. */
  compact?: boolean;
}

export function Reading({ label, source, value, unit, children, compact = false }: ReadingProps) {
  const { level, age } = useFreshness(source);
  const gone = level === "lost" || level === "never";
  const shown = gone ? UNKNOWN : value;
  return (
    <div className="reading" data-freshness={level}>
      <span className={compact ? "visually-hidden" : "reading-label"}>{label}</span>
      <span className="reading-value">
        <span className="number">{shown}</span>
        {unit !== undefined && shown !== UNKNOWN && <span className="unit">{unit}</span>}
        {level === "live" ? children : <Age level={level} age={age} />}
      </span>
    </div>
  );
}

function Age({ level, age }: { level: "stale" | "lost" | "never"; age: number }) {
  if (level === "never") return <span className="visually-hidden">no data</span>;
  return <span className="age">{level === "stale" ? `${spokenAge(age)} old` : `lost, ${spokenAge(age)}`}</span>;
}
