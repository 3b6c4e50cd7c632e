/** Camera and IMU: which motions the IMU has felt while the target was seen, and solving when enough are there. */
import { Panel } from "../components/Panel";
import { fixed } from "../components/format";
import type { CalibrationMotion, CalibrationState } from "../protocol/messages";
import { Advice } from "./Advice";
import { SolveRow } from "./SolveRow";
import { Sign, WishList } from "./WishList";
import { nameOf, nowOf, secondsOf } from "./motion";
import { madeAt } from "./target";

const LEAST_SECONDS = 5;

export function MotionPanel({ state }: { state: CalibrationState }) {
  const met = state.motions.filter((motion) => motion.met).length;
  return (
    <Panel
      title="Motion"
      className="guide"
      aside={
        <span className="hint">
          <span className="number">{fixed(state.seconds, 1)}</span> s recorded, {state.views} of {state.pictures} pictures
        </span>
      }
    >
      <Advice state={state} />
      <ul className="wishes motions" aria-label={`Motions wanted, ${met} of ${state.motions.length} met`}>
        {state.motions.map((motion) => (
          <Motion key={nameOf(motion)} motion={motion} />
        ))}
      </ul>
      <WishList label="Recording" wishes={state.wishes} />
      <p className="hint">
        Lenses: {state.lenses === "robot" ? "the robot's description" : `the calibration of ${madeAt(state.lenses)}`}. Axes
        are the IMU's: x forward, y left, z up.
      </p>
      <SolveRow
        state={state}
        lack={state.seconds < LEAST_SECONDS ? `To solve, at least ${LEAST_SECONDS} s with the target are needed.` : null}
      />
    </Panel>
  );
}

function Motion({ motion }: { motion: CalibrationMotion }) {
  return (
    <li data-met={motion.met}>
      <Sign met={motion.met} />
      <span>{nameOf(motion)}</span>
      <span className="number hint">{nowOf(motion)}</span>
      <progress aria-hidden max={motion.wanted} value={motion.seconds} />
      <span className="number">{secondsOf(motion)}</span>
    </li>
  );
}
