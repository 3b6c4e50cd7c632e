/** Posture, gait and stability of the robot. */
import { NativeSelect } from "@mantine/core";
import { useState } from "react";
import { CommandButton } from "../components/CommandButton";
import { Panel } from "../components/Panel";
import { Reading } from "../components/Reading";
import { degrees, fixed } from "../components/format";
import { command } from "../console/commands";
import { selectedRobot, useHindrance } from "../console/control";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import { ConfirmStandDialog } from "./ConfirmStandDialog";
import { GaitDiagram } from "./GaitDiagram";
import { JointTable } from "./JointTable";
import { StabilityBar } from "./StabilityBar";
import { StateTable } from "./StateTable";

const STATE = "tele/state";

export function RobotPanel() {
  const robot = useConsole(selectedRobot);
  const state = useLatest(STATE);
  const stopped = useLatest("state/mode")?.stopped ?? false;
  const [confirming, setConfirming] = useState(false);
  const stand = () => (robot?.kind === "REAL" ? setConfirming(true) : void command("stand"));
  const speed = Math.hypot(state?.velocity_in_body[0] ?? NaN, state?.velocity_in_body[1] ?? NaN);
  return (
    <Panel title="Robot" className="robot">
      <div className="button-row">
        <CommandButton name="stand" onPress={stand} className="grow">
          Stand
        </CommandButton>
        <CommandButton name="sit" variant="default" className="grow">
          Sit
        </CommandButton>
        {stopped && <p className="hint">The stop is latched. Release it when the ground around the robot is clear.</p>}
        <CommandButton name="release_stop" variant={stopped ? "filled" : "default"} color="yellow" className="grow">
          Release stop
        </CommandButton>
        <GaitPicker />
      </div>
      <GaitDiagram />
      <StabilityBar />
      <div className="readings readings-pairs">
        <Reading label="Roll" source={STATE} value={degrees(state?.roll)} unit="°" />
        <Reading label="Pitch" source={STATE} value={degrees(state?.pitch)} unit="°" />
        <Reading label="Speed" source={STATE} value={fixed(speed, 2)} unit="m/s" />
        <Reading label="Turn rate" source={STATE} value={degrees(state?.velocity_in_body[2], 0)} unit="°/s" />
      </div>
      <StateTable />
      <JointTable />
      <ConfirmStandDialog
        opened={confirming}
        robot={robot?.id ?? ""}
        onCancel={() => setConfirming(false)}
        onConfirm={() => {
          setConfirming(false);
          void command("stand");
        }}
      />
    </Panel>
  );
}

function GaitPicker() {
  const gaits = useConsole(selectedRobot)?.gaits ?? [];
  const gait = useLatest("tele/gait")?.gait;
  const hindrance = useHindrance("set_gait");
  return (
    <NativeSelect
      aria-label="Gait"
      className="grow"
      size="sm"
      value={gait ?? ""}
      disabled={hindrance !== null}
      title={hindrance ?? undefined}
      onChange={(event) => void command("set_gait", { name: event.currentTarget.value })}
    >
      {gait === undefined && <option value="">Gait unknown</option>}
      {gait !== undefined && !gaits.includes(gait) && <option value={gait}>{gait} gait</option>}
      {gaits.map((name) => (
        <option key={name} value={name}>
          {name} gait
        </option>
      ))}
    </NativeSelect>
  );
}
