/** Changes the whole adaptation at once; what the robot reports is shown, not what was asked. */
import { NativeSelect } from "@mantine/core";
import { command } from "../console/commands";
import { selectedRobot, useHindrance } from "../console/control";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";

const EXPLAINED: Record<string, string> = {
  usual: "as the ground asks",
  careful: "slower, softer, higher steps",
  "high steps": "4 cm higher: grass, rubbish",
  soft: "half the stiffness",
};

export function PresetPicker() {
  const presets = useConsole(selectedRobot)?.presets ?? [];
  const preset = useLatest("tele/adaptation")?.preset ?? "";
  const hindrance = useHindrance("set_preset");
  const offered = presets.includes(preset) ? presets : [preset, ...presets];
  return (
    <NativeSelect
      aria-label="Adaptation preset"
      size="xs"
      value={preset}
      disabled={hindrance !== null}
      title={hindrance ?? undefined}
      onChange={(event) => void command("set_preset", { name: event.currentTarget.value })}
    >
      {offered.map((name) => (
        <option key={name} value={name}>
          {name === "" ? "Preset unknown" : [name, EXPLAINED[name]].filter(Boolean).join(": ")}
        </option>
      ))}
    </NativeSelect>
  );
}
