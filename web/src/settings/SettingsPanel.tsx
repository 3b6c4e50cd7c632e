/** All settings in one list that can be searched, each with its bounds; what is outside them is not sent. */
import { TextInput } from "@mantine/core";
import { useState } from "react";
import { useParameters } from "../adaptation/parameters";
import { NumberInput } from "../components/NumberInput";
import { Panel } from "../components/Panel";
import { UNKNOWN, fixed } from "../components/format";
import { command } from "../console/commands";
import { selectedRobot, useHindrance } from "../console/control";
import { notify } from "../console/notices";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import { HELD, type Setting, found, ofParameter, ofPose, outside } from "./settings";

export function SettingsPanel() {
  const [search, setSearch] = useState("");
  const shown = found(useSettings(), search);
  return (
    <Panel title="Settings" className="settings">
      <TextInput
        type="search"
        aria-label="Search settings"
        placeholder="Search: stiffness, roll, cm …"
        size="xs"
        value={search}
        onChange={(event) => setSearch(event.currentTarget.value)}
      />
      <p className="hint">A parameter of the adaptation that is set here is held for {HELD / 60} minutes.</p>
      {shown.length === 0 && <p className="empty">No setting has such a name.</p>}
      <ul aria-label="Settings" role="list">
        {shown.map((setting) => (
          <SettingRow key={setting.label} setting={setting} />
        ))}
      </ul>
    </Panel>
  );
}

function useSettings(): Setting[] {
  const applied = useLatest("tele/adaptation")?.applied;
  const pose = useLatest("state/motion")?.pose;
  const largest = useConsole(selectedRobot)?.motion?.largest_pose ?? [];
  const adapted = useParameters().map((parameter) => ofParameter(parameter, applied?.[parameter.name] ?? null));
  return [...adapted, ...ofPose(pose, largest)];
}

function SettingRow({ setting }: { setting: Setting }) {
  const { label, unit, digits, lower, upper, value } = setting;
  const hindrance = useHindrance(setting.command);
  const set = (entered: number) => {
    const refusal = outside(setting, entered);
    if (refusal !== null) notify("error", `${label} was not set: ${refusal}.`);
    else void command(setting.command, setting.fields(entered));
  };
  return (
    <li className="setting">
      <span>{label}</span>
      {value === null ? (
        <span className="number">{UNKNOWN}</span>
      ) : (
        <NumberInput
          label={`Set ${label} in ${unit}`}
          value={value}
          digits={digits}
          disabled={hindrance !== null}
          title={hindrance ?? undefined}
          onCommit={set}
        />
      )}
      <span className="hint">
        {fixed(lower, digits)} to {fixed(upper, digits)} {unit}
      </span>
    </li>
  );
}
