/** The cameras: which views are still missing, and solving when enough are there. */
import { useState } from "react";
import { Panel } from "../components/Panel";
import type { CalibrationState } from "../protocol/messages";
import { Advice } from "./Advice";
import { CoverMap } from "./CoverMap";
import { SolveRow } from "./SolveRow";
import { WishList } from "./WishList";

const EYES = ["left", "right"];
const LEAST_VIEWS = 5;

export function GuidePanel({ state }: { state: CalibrationState }) {
  const [model, setModel] = useState("radtan");
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
      <Advice state={state} />
      <div className="covers">
        {state.cover.map((fields, eye) => (
          <CoverMap key={EYES[eye]} eye={EYES[eye] ?? ""} fields={fields} />
        ))}
      </div>
      <WishList label="Views wanted" wishes={state.wishes} />
      <SolveRow
        state={state}
        model={model}
        lack={state.views < LEAST_VIEWS ? `To solve, at least ${LEAST_VIEWS} views are needed.` : null}
      >
        <select aria-label="Lens model" value={model} onChange={(event) => setModel(event.currentTarget.value)}>
          <option value="radtan">radial-tangential lens</option>
          <option value="equidistant">equidistant (fisheye) lens</option>
        </select>
      </SolveRow>
    </Panel>
  );
}
