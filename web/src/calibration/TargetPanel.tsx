/** What is calibrated, what is looked for and where: the target's size, and the robot now or a recording. */
import { Button } from "@mantine/core";
import { useState } from "react";
import { Panel } from "../components/Panel";
import { command } from "../console/commands";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import type { CalibrationState } from "../protocol/messages";
import { startOf } from "../recording/figures";
import { type Choice, type Part, type TargetForm, type TargetKind, USUAL, faultOf, madeAt, wordsOf } from "./target";

const NOW = "";
const DESCRIBED = "";

interface TargetPanelProps {
  state: CalibrationState;
  choice: Choice;
  onChoice(choice: Choice): void;
}

export function TargetPanel({ state, choice, onChoice }: TargetPanelProps) {
  const [form, setForm] = useState<TargetForm>(USUAL);
  const [source, setSource] = useState(NOW);
  const [waiting, setWaiting] = useState(false);
  const connected = useConsole((page) => page.connection === "open");
  const recordings = useLatest("state/recording")?.entries.filter((entry) => entry.pictures) ?? [];
  const fault = faultOf(form);
  const running = state.phase !== "idle";

  const start = async () => {
    setWaiting(true);
    await command("start_calibration", { name: wordsOf(form, choice, source) });
    setWaiting(false);
  };
  const number = (label: string, field: "columns" | "rows" | "size" | "spacing", step: string) => (
    <label className="field">
      <span>{label}</span>
      <input
        type="number"
        step={step}
        min="0"
        value={Number.isNaN(form[field]) ? "" : form[field]}
        onChange={(event) => setForm({ ...form, [field]: event.currentTarget.valueAsNumber })}
      />
    </label>
  );

  return (
    <Panel title="Target" className="target">
      <div className="fields">
        <label className="field field-wide">
          <span>Calibrate</span>
          <select
            value={choice.part}
            onChange={(event) => onChoice({ ...choice, part: event.currentTarget.value as Part })}
          >
            <option value="cameras">1. Cameras: lenses, and the eyes' places</option>
            <option value="imu">2. Camera and IMU: place, turn and delay</option>
          </select>
        </label>
        <label className="field">
          <span>Kind</span>
          <select
            value={form.kind}
            onChange={(event) => setForm({ ...form, kind: event.currentTarget.value as TargetKind })}
          >
            <option value="aprilgrid">AprilGrid</option>
            <option value="checkerboard">Chessboard</option>
          </select>
        </label>
        {number(form.kind === "aprilgrid" ? "Tags across" : "Inner corners across", "columns", "1")}
        {number(form.kind === "aprilgrid" ? "Tags upwards" : "Inner corners upwards", "rows", "1")}
        {number(form.kind === "aprilgrid" ? "Tag size, mm" : "Square size, mm", "size", "any")}
        {form.kind === "aprilgrid" && number("Gap over tag size", "spacing", "any")}
        <label className="field field-wide">
          <span>{choice.part === "imu" ? "Pictures and IMU from" : "Pictures from"}</span>
          <select value={source} onChange={(event) => setSource(event.currentTarget.value)}>
            <option value={NOW}>{choice.part === "imu" ? "the robot, now" : "the robot's cameras, now"}</option>
            {recordings.map((entry) => (
              <option key={entry.name} value={entry.name}>
                the recording of {startOf(entry.started)}
              </option>
            ))}
          </select>
        </label>
        {choice.part === "imu" && (
          <label className="field field-wide">
            <span>Lenses from</span>
            <select
              value={choice.lenses}
              onChange={(event) => onChoice({ ...choice, lenses: event.currentTarget.value })}
            >
              <option value={DESCRIBED}>the robot's description</option>
              {state.calibrations.map((folder) => (
                <option key={folder} value={folder}>
                  the calibration of {madeAt(folder)}
                </option>
              ))}
            </select>
          </label>
        )}
      </div>
      {fault !== null && <p className="hint">{fault}</p>}
      <div className="button-row">
        <Button
          className="grow"
          variant={running ? "default" : "filled"}
          loading={waiting}
          disabled={!connected || fault !== null || state.phase === "solving"}
          onClick={() => void start()}
        >
          {running ? "Start again" : "Start looking"}
        </Button>
        <Button
          variant="default"
          disabled={!connected || !running || state.phase === "solving"}
          onClick={() => void command("end_calibration")}
        >
          End
        </Button>
      </div>
      <p className="hint">
        {choice.part === "imu" ? (
          "Fix the target and move the robot before it for half a minute: quick turns and pushes, the target always in view."
        ) : (
          <>
            Print a target with <code>weaver calibrate target --out target.pdf</code>, fix it flat, and measure it.
          </>
        )}
      </p>
    </Panel>
  );
}
