/** The verdict, the main figures, Kalibr's files to download, and the report with its residual plots. */
import { Button } from "@mantine/core";
import { Panel } from "../components/Panel";
import { sentence } from "../components/format";
import type { CalibrationState } from "../protocol/messages";
import type { Choice } from "./target";

interface ResultPanelProps {
  robot: string;
  state: CalibrationState;
  /** Go on with another part. */
  onNext(choice: Choice): void;
}

export function ResultPanel({ robot, state, onNext }: ResultPanelProps) {
  const address = (file: string) => `/api/calibrations/${[robot, ...file.split("/")].map(encodeURIComponent).join("/")}`;
  const report = state.files.find((file) => file.endsWith("report.html"));
  const folder = state.files[0]?.split("/")[0];
  return (
    <Panel title="Result" className="calibration-result">
      <p className="verdict" role="status" aria-label="Verdict" data-usable={state.usable}>
        {sentence(state.verdict)}.
      </p>
      {state.results.length > 0 && (
        <ul className="results">
          {state.results.map((line) => (
            <li key={line}>{sentence(line)}</li>
          ))}
        </ul>
      )}
      {state.files.length > 0 && (
        <>
          <ul className="files" aria-label="Files">
            {state.files.map((file) => (
              <li key={file}>
                <a href={address(file)} download={nameOf(file)}>
                  {nameOf(file)}
                </a>
              </li>
            ))}
          </ul>
          <p className="hint">
            On the robot in {state.folder}/{folder}
          </p>
          {state.part === "cameras" && state.usable && folder !== undefined && (
            <Button variant="default" onClick={() => onNext({ part: "imu", lenses: folder })}>
              Go on with camera and IMU
            </Button>
          )}
        </>
      )}
      {report !== undefined && (
        <iframe className="report" title="Calibration report" sandbox="" src={address(report)} loading="lazy" />
      )}
    </Panel>
  );
}

function nameOf(file: string): string {
  return file.slice(file.lastIndexOf("/") + 1);
}
