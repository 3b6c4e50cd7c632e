/** A native checkbox drawn as a switch. Enter toggles it, since Space stops the robot. */
import { type KeyboardEvent, useId } from "react";

interface SwitchProps {
  label: string;
  checked: boolean;
  onChange(checked: boolean): void;
  disabled?: boolean;
  description?: string;
}

export function Switch({ label, checked, onChange, disabled = false, description }: SwitchProps) {
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
        aria-describedby={description === undefined ? undefined : `${id}-description`}
      />
      <label htmlFor={id}>{label}</label>
      {description !== undefined && (
        <span id={`${id}-description`} className="hint">
          {description}
        </span>
      )}
    </div>
  );
}
