/** Calibrating the robot's cameras and its IMU, guided: what is seen, what is missing, solving, the report. */
import { useEffect, useState } from "react";
import { spokenAge } from "../console/freshness";
import { type Stamped, useConsole } from "../console/store";
import { useFreshness, useLatest } from "../console/useLatest";
import type { CalibrationState } from "../protocol/messages";
import { watch } from "../scene/watching";
import { GuidePanel } from "./GuidePanel";
import { MotionPanel } from "./MotionPanel";
import { ResultPanel } from "./ResultPanel";
import { TargetPanel } from "./TargetPanel";
import type { Choice } from "./target";

const STATE = "state/calibration";
const PICTURE = "tele/cam/calibration";

export default function CalibrationPage() {
  const state = useLatest(STATE);
  const robot = useConsole((page) => page.selected);
  const [choice, setChoice] = useState<Choice>({ part: state?.part ?? "cameras", lenses: "" });
  useEffect(() => {
    watch({ cameras: true, features: false });
  }, []);
  return (
    <main className="calibration">
      <nav className="calibration-head">
        <h2>Calibrate cameras and IMU</h2>
        <a href="#">Back to the robot</a>
      </nav>
      {state === undefined || robot === null ? (
        <p className="view-empty">
          {robot === null ? "Choose a robot first." : "This robot has no calibrator. Start it with weaver calibrate guide."}
        </p>
      ) : (
        <div className="calibration-parts">
          <div className="panel-column">
            <Pictures state={state} />
            {state.verdict !== "" && <ResultPanel robot={robot} state={state} onNext={setChoice} />}
          </div>
          <div className="panel-column">
            {state.phase !== "idle" && (state.part === "imu" ? <MotionPanel state={state} /> : <GuidePanel state={state} />)}
            <TargetPanel state={state} choice={choice} onChoice={setChoice} />
          </div>
        </div>
      )}
    </main>
  );
}

function Pictures({ state }: { state: CalibrationState }) {
  const picture = useConsole((page) => (page.values[PICTURE] as Stamped<{ jpeg: string }> | undefined)?.value);
  const { level, age } = useFreshness(PICTURE);
  if (state.phase === "idle") {
    return <p className="view-empty calibration-eyes">Start looking to see both eyes with the corners they find.</p>;
  }
  if (picture === undefined || state.pictures === 0) {
    return <p className="view-empty calibration-eyes">Waiting for the first pictures.</p>;
  }
  const seen = state.seen.map((count, eye) => `${count} in the ${eye === 0 ? "left" : "right"} eye`).join(", ");
  return (
    <figure className="calibration-eyes">
      <img src={`data:image/jpeg;base64,${picture.jpeg}`} alt={`Left and right eye; corners found: ${seen}`} />
      <figcaption>
        Target: {state.target}. Corners found: <span className="number">{seen}</span>
        {state.source !== "cameras" && `, in ${state.source}`}
        {level !== "live" && state.phase === "looking" && `; ${spokenAge(age)} old`}
      </figcaption>
    </figure>
  );
}
