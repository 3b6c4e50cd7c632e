/** A number in a text field, taken over with Enter or on leaving the field; nonsense is put back. */
import { useEffect, useState } from "react";
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
  const [text, setText] = useState(shown);
  useEffect(() => setText(shown), [shown]);
  const commit = () => {
    const entered = Number(text.replace(",", "."));
    if (text.trim() === "" || !Number.isFinite(entered) || text === shown) setText(shown);
    else onCommit(entered);
  };
  return (
    <input
      type="text"
      inputMode="decimal"
      aria-label={label}
      value={text}
      disabled={disabled}
      title={title}
      onChange={(event) => setText(event.currentTarget.value)}
      onBlur={commit}
      onKeyDown={(event) => event.key === "Enter" && commit()}
    />
  );
}
