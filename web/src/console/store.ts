/** The page's one store: newest value of every key, the robots, the link and the log. Written by `session.ts` alone. */
import { create } from "zustand";
import type {
  AdaptationReport,
  CalibrationState,
  ForbiddenAreas,
  GaitState,
  Health,
  LeaseState,
  LocomotionState,
  MissionOutlook,
  MissionState,
  ModeState,
  MotionOrders,
  PowerState,
  RecordingState,
  ReplayMarks,
  ReplayState,
  RobotState,
  ServoStates,
  TruthState,
} from "../protocol/messages";
import type { ControlRequest, Hello, Legend, LinkReport, LogEntry, RequestState, RobotEntry } from "../protocol/wire";

/** What travels under which key; health and pictures come under one key per process and camera. */
export interface Topics {
  "tele/state": RobotState;
  "tele/gait": GaitState;
  "tele/adaptation": AdaptationReport;
  "tele/power": PowerState;
  "tele/servos": ServoStates;
  "tele/locomotion": LocomotionState;
  "state/mode": ModeState;
  "state/motion": MotionOrders;
  "state/lease": LeaseState;
  "state/mission": MissionState;
  "state/areas": ForbiddenAreas;
  "state/outlook": MissionOutlook;
  "state/recording": RecordingState;
  "state/replay": ReplayState;
  "state/replay_marks": ReplayMarks;
  "state/calibration": CalibrationState;
  "truth/state": TruthState;
  [health: `tele/health/${string}`]: Health;
}

export interface Stamped<T> {
  readonly value: T;
  /** Page clock (ms, `performance.now()`) at which the console had it. */
  readonly received: number;
}

export type Connection = "connecting" | "open" | "lost" | "replaced" | "login";

export interface Notice {
  readonly id: number;
  readonly severity: "info" | "warning" | "error";
  readonly text: string;
  readonly at: number;
}

export interface ConsoleState {
  connection: Connection;
  /** Page clock at which the connection was lost. */
  lostAt: number | null;
  hello: Hello | null;
  robots: readonly RobotEntry[];
  selected: string | null;
  values: Readonly<Record<string, Stamped<unknown>>>;
  link: LinkReport | null;
  linkReceived: number;
  legend: Legend | null;
  events: readonly LogEntry[];
  /** Seconds there and back, page to console. */
  roundTrip: number | null;
  roundTripReceived: number;
  /** Seconds there and back, page to robot, of the last answered command. */
  commandRoundTrip: number | null;
  /** Operators who ask this page for control. */
  requests: readonly ControlRequest[];
  /** This page's own request for control, while it waits. */
  asking: RequestState | null;
  notices: readonly Notice[];
  /** A stop that could not be sent yet. */
  stopPending: boolean;
  /** The page's clock, ticking 4 times a second: what ages are counted against. */
  now: number;
}

export const INITIAL: ConsoleState = {
  connection: "connecting",
  lostAt: null,
  hello: null,
  robots: [],
  selected: null,
  values: {},
  link: null,
  linkReceived: 0,
  legend: null,
  events: [],
  roundTrip: null,
  roundTripReceived: 0,
  commandRoundTrip: null,
  requests: [],
  asking: null,
  notices: [],
  stopPending: false,
  now: 0,
};

export const useConsole = create<ConsoleState>(() => INITIAL);

export function latest<K extends keyof Topics>(state: ConsoleState, key: K): Stamped<Topics[K]> | undefined {
  return state.values[key] as Stamped<Topics[K]> | undefined;
}
