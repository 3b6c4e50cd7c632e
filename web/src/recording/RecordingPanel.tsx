/** The robot's recorder: start and stop, what runs, and what is there to download. Needs no control of the robot. */
import { Button } from "@mantine/core";
import { useState } from "react";
import { Panel } from "../components/Panel";
import { Switch } from "../components/Switch";
import { command } from "../console/commands";
import { spokenAge } from "../console/freshness";
import { useConsole } from "../console/store";
import { useFreshness, useLatest } from "../console/useLatest";
import type { RecordingState } from "../protocol/messages";
import { clockOf, sizeOf } from "./figures";
import { RecordingList } from "./RecordingList";

const SOURCE = "state/recording";

export function RecordingPanel() {
  const state = useLatest(SOURCE);
  const { level, age } = useFreshness(SOURCE);
  const connected = useConsole((page) => page.connection === "open");
  const robot = useConsole((page) => page.selected);
  const [pictures, setPictures] = useState(true);
  const [waiting, setWaiting] = useState(false);
  const heard = state !== undefined && level !== "lost";
  const running = heard && state.active !== "";

  const ask = async (name: "start_recording" | "stop_recording") => {
    setWaiting(true);
    await command(name, name === "start_recording" ? { value: pictures ? 1 : 0 } : {});
    setWaiting(false);
  };

  return (
    <Panel title="Recording" className="recording" aside={running && <Running state={state} stale={level === "stale"} />}>
      {!heard ? (
        <p className="empty">
          {state === undefined ? "This robot has no recorder." : `The recorder is lost, ${spokenAge(age)}.`}
        </p>
      ) : (
        <>
          <div className="button-row">
            <Button
              className={running ? "grow recording-stop" : "grow"}
              variant="default"
              loading={waiting}
              disabled={!connected}
              onClick={() => void ask(running ? "stop_recording" : "start_recording")}
            >
              {running ? "Stop recording" : "Start recording"}
            </Button>
            <Switch label="Record camera pictures" checked={pictures} disabled={running} onChange={setPictures} />
          </div>
          <Remarks state={state} />
          <a className="link-button" href="#calibration">
            Calibrate cameras and IMU
          </a>
          {robot !== null && <RecordingList robot={robot} entries={state.entries} />}
        </>
      )}
    </Panel>
  );
}

function Running({ state, stale }: { state: RecordingState; stale: boolean }) {
  return (
    <span className="recording-running" data-stale={stale} role="status" aria-label="Recording now">
      <span className="recording-dot" aria-hidden />
      <span className="number">{clockOf(state.seconds)}</span>
      <span className="number">{sizeOf(state.size)}</span>
      {!state.pictures && <span className="hint">no pictures</span>}
    </span>
  );
}

function Remarks({ state }: { state: RecordingState }) {
  return (
    <>
      {state.lost > 0 && <p className="tag tag-caution">{state.lost} messages lost: the robot's disk is too slow</p>}
      {state.reason !== "" && <p className="tag tag-caution">The last recording ended: {state.reason}</p>}
      <p className="hint">
        {sizeOf(state.free)} free in {state.folder} on the robot
      </p>
    </>
  );
}
