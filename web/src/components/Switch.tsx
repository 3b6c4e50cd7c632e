/** A native checkbox drawn as a switch. Enter toggles it, since Space stops the robot. */
import { type KeyboardEvent, useId } from "react";

interface SwitchProps {
  label: string;
  checked: boolean;
  onChange(checked: boolean): void;
  disabled?: boolean;
  /** A shorter text to show where the place says the rest. */
  shown?: string;
}

export function Switch({ label, checked, onChange, disabled = false, shown }: SwitchProps) {
  const id = useId();
  const toggleOnEnter = (event: KeyboardEvent<HTMLInputElement>) => {
    if (event.key !== "Enter" || disabled) return;
    event.preventDefault();
    onChange(!checked);
  };
  return (
    <div className="switch">
      <input
        id={id}
        type="checkbox"
        role="switch"
        checked={checked}
        disabled={disabled}
        onChange={(event) => onChange(event.currentTarget.checked)}
        onKeyDown={toggleOnEnter}
        aria-label={label}
      />
      <label htmlFor={id}>{shown ?? label}</label>
    </div>
  );
}
