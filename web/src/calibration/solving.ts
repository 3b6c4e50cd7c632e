/** How far solving has come, from the name of the step that runs. */
import type { Part } from "./target";

const STEPS: Record<Part, readonly string[]> = {
  cameras: ["lens of the left eye", "lens of the right eye", "both eyes together"],
  imu: ["places of the pictures", "turn and delay", "all together", "how sure it is"],
};

/** From 0 to 1. A step may count its own: "all together, step 3 of at most 25". */
export function shareSolved(part: Part, step: string): number {
  const steps = STEPS[part];
  const done = steps.findIndex((name) => step.startsWith(name));
  if (done < 0) return 0;
  const own = /step (\d+) of at most (\d+)/.exec(step);
  return (done + (own === null ? 0 : (Number(own[1]) - 1) / Number(own[2]))) / steps.length;
}
