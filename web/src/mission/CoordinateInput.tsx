/** A coordinate in metres, taken over with Enter or on leaving the field; nonsense is put back. */
import { useEffect, useState } from "react";

interface CoordinateInputProps {
  label: "x" | "y";
  /** What it belongs to: "waypoint 2". */
  name: string;
  value: number;
  onCommit(value: number): void;
}

export function CoordinateInput({ label, name, value, onCommit }: CoordinateInputProps) {
  const [text, setText] = useState(shown(value));
  useEffect(() => setText(shown(value)), [value]);
  const commit = () => {
    const entered = Number(text.replace(",", "."));
    if (text.trim() === "" || !Number.isFinite(entered)) setText(shown(value));
    else if (entered !== value) onCommit(entered);
  };
  return (
    <label className="coordinate">
      <input
        type="text"
        inputMode="decimal"
        aria-label={`${label} of ${name} in metres`}
        value={text}
        onChange={(event) => setText(event.currentTarget.value)}
        onBlur={commit}
        onKeyDown={(event) => event.key === "Enter" && commit()}
      />
    </label>
  );
}

function shown(value: number): string {
  return value.toFixed(2);
}
