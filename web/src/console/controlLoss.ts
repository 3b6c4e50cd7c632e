/** Tells the operator when control is gone without having been given back, and on return what an outage has done. */
import { holder, holdsControl } from "./control";
import { spokenAge } from "./freshness";
import { notify } from "./notices";
import type { ConsoleState } from "./store";

/** An outage is told of if this page had control so many ms before it was noticed: a dead network is noticed late. */
const NOTICED_WITHIN = 15_000;

interface Hold {
  robot: string | null;
  at: number;
}

let releaseAsked = false;
/** When this page last had control of a robot, and of which. */
let held: Hold | null = null;
let outage: Hold | null = null;

/** The next loss of control is the operator's own wish. */
export function expectRelease(): void {
  releaseAsked = true;
}

/** The connection is gone: on return the operator is told what has become of the robot that was under control. */
export function expectReturn(now: number): void {
  if (held !== null && now - held.at < NOTICED_WITHIN) outage ??= held;
  held = null;
}

export function tellLossOfControl(before: ConsoleState, after: ConsoleState): void {
  if (holdsControl(after)) held = { robot: after.selected, at: after.now };
  if (outage !== null) {
    const lease = after.values["state/lease"];
    const told = lease !== undefined && lease !== before.values["state/lease"];
    if (told && after.selected === outage.robot) notify(...afterOutage(after, outage.at));
    if (told) outage = null;
    return;
  }
  if (!holdsControl(before) || holdsControl(after) || before.selected !== after.selected) return;
  if (after.values["state/lease"] === undefined) return; // sent anew after a reconnection
  held = null;
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

function afterOutage(state: ConsoleState, since: number): Parameters<typeof notify> {
  const gone = `The robot was not heard from here for ${spokenAge(Math.round((state.now - since) / 1000))}.`;
  const owner = holder(state);
  if (holdsControl(state)) return ["info", `${gone} You still have control.`];
  if (owner !== "" && owner !== state.hello?.operator) return ["warning", `${gone} It stopped by itself; ${owner} has control now.`];
  return ["warning", `${gone} It stopped by itself and holds still; you no longer have control.`];
}
