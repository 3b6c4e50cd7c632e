/** Frames of the page's socket (docs/console_protocol.md). */
import type { CommandName, EventMessage, RobotKind, Waypoint } from "./messages";

export type Role = "viewer" | "operator" | "admin";

export interface Hello {
  type: "hello";
  page: string;
  operator: string;
  /** Who has logged in, empty where nobody needs to. */
  user: string;
  role: Role;
  version: string;
  scene: string | null;
  layers: string[];
  layer: string;
  /** Distance at which the robot turns to the next waypoint, and at which the last one is reached, m. */
  passing_radius_m: number;
  goal_radius_m: number;
  schema: number;
}

/** What may be asked of body and legs beyond walking, in m, rad, m/s and rad/s. */
export interface MotionLimits {
  /** Largest amount either way of x, y, z, roll, pitch, yaw. */
  largest_pose: number[];
  largest_tip: number;
  largest_cruise: number[];
  cruise_seconds: number;
  postures: string[];
  packs: boolean;
  /** How far beside the way feet are expected. */
  half_width: number;
}

export interface RobotEntry {
  id: string;
  session: string;
  kind: RobotKind;
  robot: string;
  world: string;
  alive: boolean;
  heartbeat_age_s: number | null;
  processes: string[];
  mode: string;
  stopped: boolean;
  holder: string;
  leg_names: string[];
  joint_names: string[];
  gaits: string[];
  presets: string[];
  joint_limits: [number, number][];
  /** What an operator may set of the adapted parameters; absent names are not adjustable. */
  parameters?: Record<string, { lower: number; upper: number; unit: string; roughness?: number[]; step_height?: number[] }>;
  motion?: MotionLimits | null;
  conflict: string;
}

export interface ValueFrame {
  type: "value";
  robot: string;
  key: string;
  kind: string;
  stamp_ns: number;
  age_s: number;
  value: unknown;
}

export interface LinkReport {
  type: "link";
  robot: string;
  alive: boolean;
  heartbeat_age_s: number | null;
  /** Share of the robot's heartbeats that did not reach the console; null unknown. */
  loss: number | null;
  rates: Record<string, number>;
}

export interface LogEntry extends EventMessage {
  robot: string;
  time: number;
}

export interface Answer {
  type: "answer";
  id: string | null;
  robot: string;
  command: string;
  accepted: boolean;
  reason: string;
  applied_value: number | null;
  lease_epoch: number;
  round_trip_s: number | null;
}

export interface Legend {
  type: "legend";
  layer: string;
  label: string;
  unit: string;
  stops: [value: number, colour: string][];
  unknown: string;
}

/** Another operator asks this page for control. */
export interface ControlRequest {
  type: "asked";
  robot: string;
  asker: string;
  reason: string;
  answer_within_s: number;
}

/** What has become of this page's own request. */
export interface RequestState {
  type: "request";
  robot: string;
  holder: string;
  state: "waiting" | "granted" | "declined" | "unanswered" | "lost" | "over";
  text: string;
}

export type Incoming =
  | Hello
  | { type: "robots"; robots: RobotEntry[] }
  | { type: "selected"; robot: string | null }
  | ValueFrame
  | { type: "forget"; robot: string; keys: string[] }
  | LinkReport
  | { type: "events"; events: LogEntry[] }
  | ({ type: "event" } & LogEntry)
  | Answer
  | { type: "picked"; x: number; y: number; z: number }
  | { type: "missed"; reason: string }
  | { type: "dragged"; index: number; x: number; y: number; z: number; done: boolean }
  | Legend
  | { type: "role"; role: Role }
  | ControlRequest
  | { type: "asked_no_more"; robot: string; asker: string }
  | RequestState
  | { type: "pong"; t: number }
  | { type: "error"; reason: string };

export interface CommandFields {
  robot?: string;
  reason?: string;
  name?: string;
  value?: number;
  seconds?: number;
  waypoints?: readonly Waypoint[];
}

export type Outgoing =
  | { type: "select"; robot: string | null }
  | ({ type: "command"; id: string; command: CommandName } & CommandFields)
  | { type: "retain" }
  | { type: "ask_for_control"; reason: string }
  | { type: "answer_request"; asker: string; grant: boolean }
  | { type: "teleop"; forward: number; left: number; turn: number; dead_man: boolean }
  | {
      type: "draft";
      waypoints: readonly Waypoint[];
      selected: number | null;
      areas: readonly (readonly Waypoint[])[];
    }
  | { type: "layer"; name: string }
  | {
      type: "view";
      follow?: boolean;
      truth?: boolean;
      frusta?: boolean;
      trail?: boolean;
      contours?: boolean;
      torques?: boolean;
    }
  | { type: "measure"; places: readonly Waypoint[] }
  | { type: "watch"; cameras: boolean; features: boolean }
  | { type: "ping"; t: number }
  | { type: "taken"; frames: number };

/** The messages of a frame; an unreadable frame is none, so that one bad sender can not stop the page. */
export function parseFrame(text: string): Incoming[] {
  let frame: unknown;
  try {
    frame = JSON.parse(text);
  } catch {
    return [];
  }
  return Array.isArray(frame) ? frame.filter(isMessage) : [];
}

function isMessage(item: unknown): item is Incoming {
  return typeof item === "object" && item !== null && typeof (item as { type?: unknown }).type === "string";
}
