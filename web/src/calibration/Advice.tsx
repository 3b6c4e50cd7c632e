/** What to do next, said aloud as it changes. */
import { sentence } from "../components/format";
import type { CalibrationState } from "../protocol/messages";

export function Advice({ state }: { state: CalibrationState }) {
  if (state.phase !== "starting" && state.phase !== "looking") return null;
  return (
    <p className="advice" role="status" aria-label="What to do next">
      {sentence(state.advice)}
    </p>
  );
}
