/** A coordinate in metres. */
import { NumberInput } from "../components/NumberInput";

interface CoordinateInputProps {
  label: "x" | "y";
  /** What it belongs to: "waypoint 2". */
  name: string;
  value: number;
  onCommit(value: number): void;
}

export function CoordinateInput({ label, name, value, onCommit }: CoordinateInputProps) {
  return (
    <label className="coordinate">
      <NumberInput label={`${label} of ${name} in metres`} value={value} digits={2} onCommit={onCommit} />
    </label>
  );
}
