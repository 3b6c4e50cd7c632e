/** Tells the operator when control is gone without having been given back. */
import { holder, holdsControl } from "./control";
import { notify } from "./notices";
import type { ConsoleState } from "./store";

let releaseAsked = false;

/** The next loss of control is the operator's own wish. */
export function expectRelease(): void {
  releaseAsked = true;
}

export function tellLossOfControl(before: ConsoleState, after: ConsoleState): void {
  if (!holdsControl(before) || holdsControl(after) || before.selected !== after.selected) return;
  if (after.values["state/lease"] === undefined) return; // sent anew after a reconnection
  const asked = releaseAsked;
  releaseAsked = false;
  if (asked) return;
  const owner = holder(after);
  notify(
    "warning",
    owner === ""
      ? "You no longer have control: the robot did not hear from this page for too long. It holds still."
      : `You no longer have control: ${owner} has taken it.`,
  );
}
