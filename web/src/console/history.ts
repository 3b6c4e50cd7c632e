/** The last minute of what is plotted. Kept outside the store: appended often, read when drawn. */
import type { AdaptationReport, GaitState, ParameterName, RobotState } from "../protocol/messages";

const SPAN = 60; // s
const TRAIL_STEP = 0.03; // m between kept positions
const TRAIL_LENGTH = 4000;

export const PARAMETERS: readonly ParameterName[] = ["virtual_stiffness", "stride_frequency", "stride_height"];

export interface ParameterSample {
  seconds: number;
  applied: number | null;
  desired: number | null;
}

export interface SwingSample {
  seconds: number;
  swing: readonly boolean[];
}

export interface TrailPoint {
  x: number;
  y: number;
  /** Cost of transport of the way up to there; null unknown. */
  cost: number | null;
}

export class History {
  readonly parameters: Record<ParameterName, ParameterSample[]> = {
    virtual_stiffness: [],
    stride_frequency: [],
    stride_height: [],
  };
  swings: SwingSample[] = [];
  trail: TrailPoint[] = [];

  clear(): void {
    for (const name of PARAMETERS) this.parameters[name] = [];
    this.swings = [];
    this.trail = [];
  }

  addAdaptation(report: AdaptationReport): void {
    const seconds = report.stamp_ns / 1e9;
    for (const name of PARAMETERS) {
      const sample = { seconds, applied: report.applied[name], desired: report.desired[name] };
      this.parameters[name] = recent(this.parameters[name], sample);
    }
  }

  addGait(gait: GaitState): void {
    this.swings = recent(this.swings, { seconds: gait.stamp_ns / 1e9, swing: gait.swing });
  }

  addState(state: RobotState, cost: number | null): void {
    const [x, y] = state.position_in_world;
    if (typeof x !== "number" || typeof y !== "number") return;
    const last = this.trail.at(-1);
    if (last !== undefined && Math.hypot(x - last.x, y - last.y) < TRAIL_STEP) return;
    this.trail.push({ x, y, cost });
    if (this.trail.length > TRAIL_LENGTH) this.trail.shift();
  }
}

/** A clock that jumped back means another run: the old samples are void. */
function recent<T extends { seconds: number }>(samples: T[], sample: T): T[] {
  const last = samples.at(-1);
  if (last !== undefined && sample.seconds < last.seconds) return [sample];
  if (last !== undefined && sample.seconds === last.seconds) return samples;
  const first = samples.findIndex((old) => old.seconds >= sample.seconds - SPAN);
  return [...(first > 0 ? samples.slice(first) : samples), sample];
}
