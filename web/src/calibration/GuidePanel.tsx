/** What to do next, what is still missing, and solving when enough is there. */
import { Button } from "@mantine/core";
import { useState } from "react";
import { Panel } from "../components/Panel";
import { sentence } from "../components/format";
import { command } from "../console/commands";
import { useConsole } from "../console/store";
import type { CalibrationState } from "../protocol/messages";
import { CoverMap } from "./CoverMap";
import { STEP_COUNT, stepsDone } from "./target";

const EYES = ["left", "right"];
const LEAST_VIEWS = 5;

export function GuidePanel({ state }: { state: CalibrationState }) {
  const connected = useConsole((page) => page.connection === "open");
  const [model, setModel] = useState("radtan");
  const met = state.wishes.filter((wish) => wish.met).length;
  return (
    <Panel
      title="Views"
      className="guide"
      aside={
        <span className="hint">
          {state.views} kept of {state.pictures} pictures
        </span>
      }
    >
      <p className="advice" role="status" aria-label="What to do next">
        {sentence(state.advice)}
      </p>
      <div className="covers">
        {state.cover.map((fields, eye) => (
          <CoverMap key={EYES[eye]} eye={EYES[eye] ?? ""} fields={fields} />
        ))}
      </div>
      <ul className="wishes" aria-label={`Views wanted, ${met} of ${state.wishes.length} met`}>
        {state.wishes.map((wish) => (
          <li key={wish.advice} data-met={wish.met}>
            <span aria-hidden>{wish.met ? "✓" : "○"}</span>
            <span className="visually-hidden">{wish.met ? "met:" : "missing:"}</span>
            <span>{wish.what}</span>
          </li>
        ))}
      </ul>
      {state.phase === "solving" ? (
        <label className="solving">
          Solving: {state.step}
          <progress max={STEP_COUNT} value={stepsDone(state.step)} />
        </label>
      ) : (
        <div className="button-row">
          <select aria-label="Lens model" value={model} onChange={(event) => setModel(event.currentTarget.value)}>
            <option value="radtan">radial-tangential lens</option>
            <option value="equidistant">equidistant (fisheye) lens</option>
          </select>
          <Button
            className="grow"
            disabled={!connected || state.views < LEAST_VIEWS}
            title={state.views < LEAST_VIEWS ? `at least ${LEAST_VIEWS} views are needed` : undefined}
            onClick={() => void command("solve_calibration", { name: model })}
          >
            Solve and save
          </Button>
        </div>
      )}
    </Panel>
  );
}
