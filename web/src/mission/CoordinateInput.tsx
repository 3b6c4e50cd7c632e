/** A coordinate in metres, taken over with Enter or on leaving the field; nonsense is put back. */
import { useEffect, useState } from "react";
import { fixed } from "../components/format";

interface CoordinateInputProps {
  label: "x" | "y";
  /** What it belongs to: "waypoint 2". */
  name: string;
  value: number;
  onCommit(value: number): void;
}

export function CoordinateInput({ label, name, value, onCommit }: CoordinateInputProps) {
  const [text, setText] = useState(fixed(value, 2));
  useEffect(() => setText(fixed(value, 2)), [value]);
  const commit = () => {
    const entered = Number(text.replace(",", "."));
    if (text.trim() === "" || !Number.isFinite(entered) || entered === value) setText(fixed(value, 2));
    else onCommit(entered);
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
