/** A number in a text field, taken over with Enter or on leaving the field; nonsense is put back. A value
 *  that changes by itself does not change what is being typed. */
import { useState } from "react";
import { fixed } from "./format";

interface NumberInputProps {
  label: string;
  value: number;
  digits: number;
  disabled?: boolean;
  title?: string | undefined;
  onCommit(value: number): void;
}

export function NumberInput({ label, value, digits, disabled = false, title, onCommit }: NumberInputProps) {
  const shown = fixed(value, digits);
  /** null while nobody types. */
  const [typed, setTyped] = useState<string | null>(null);
  const commit = () => {
    setTyped(null);
    const entered = Number(typed?.replace(",", ".").trim() || NaN);
    if (Number.isFinite(entered) && typed !== shown) onCommit(entered);
  };
  return (
    <input
      type="text"
      inputMode="decimal"
      aria-label={label}
      value={typed ?? shown}
      disabled={disabled}
      title={title}
      onChange={(event) => setTyped(event.currentTarget.value)}
      onBlur={commit}
      onKeyDown={({ key }) => key === "Enter" && commit()}
    />
  );
}
