/** Messages of shared/weaver_shared/messages as they reach the page. SI units; an unknown number is null. */

export type Maybe = number | null;

export interface Waypoint {
  x: number;
  y: number;
}

export type RobotKind = "SIM" | "EMULATED BUS" | "REAL" | "REPLAY";
export type Severity = "info" | "warning" | "error";
export type Mode = "OFF" | "READY" | "STAND" | "WALK" | "SIT" | "HOLD" | "FAULT" | "ESTOP";

export const COMMAND_NAMES = [
  "take_control",
  "release_control",
  "retain_control",
  "stand",
  "sit",
  "stop",
  "release_stop",
  "set_mission",
  "start_mission",
  "pause_mission",
  "clear_mission",
  "set_areas",
  "skip_waypoint",
  "return_to_start",
  "set_override",
  "clear_override",
  "set_preset",
  "set_perception",
  "set_gait",
  "start_cruise",
  "stop_cruise",
  "set_start_up",
  "change_posture",
  "set_pose",
  "clear_pose",
  "lift_leg",
  "lower_leg",
  "move_tip",
  "move_joint",
  "place_foot",
  "set_posing",
  "look_closely",
  "start_recording",
  "stop_recording",
  "start_replay",
  "play_replay",
  "jump_replay",
  "end_replay",
  "start_calibration",
  "solve_calibration",
  "end_calibration",
] as const;
export type CommandName = (typeof COMMAND_NAMES)[number];

export interface Presence {
  robot_id: string;
  session: string;
  kind: RobotKind;
  robot: string;
  world: string;
  schema: number;
}

export interface ModeState {
  stamp_ns: number;
  mode: Mode;
  action: "allow" | "hold" | "sit" | "cut";
  reasons: string[];
  stopped: boolean;
  stop_level: "" | "settle" | "cut";
  allowed: CommandName[];
}

export interface LeaseState {
  holder: string;
  epoch: number;
  seconds_left: number;
}

export interface MissionState {
  stamp_ns: number;
  phase: "empty" | "ready" | "active" | "paused" | "done";
  waypoints: Waypoint[];
  next_waypoint: number;
  cross_track_error: Maybe;
  distance_left: Maybe;
  lookahead_in_world: Maybe[];
}

/** Ground that no mission is walked into. */
export interface ForbiddenAreas {
  stamp_ns: number;
  areas: Waypoint[][];
}

/** What time and energy of a mission are estimated from. */
export interface MissionOutlook {
  stamp_ns: number;
  start_in_world: Maybe[];
  /** m/s along the way. */
  speed: Maybe;
  speed_basis: "measured" | "gait";
  /** m of way that speed and energy were measured over; 0: not measured. */
  measured_over: number;
  /** J/m */
  energy_per_metre: Maybe;
  cost_of_transport: Maybe;
}

export interface RobotState {
  stamp_ns: number;
  position_in_world: Maybe[];
  wxyz: Maybe[];
  velocity_command: Maybe[];
  velocity_in_body: Maybe[];
  joint_position: Maybe[];
  joint_torque: Maybe[];
  foot_in_body: Maybe[][];
  foot_contact: boolean[];
  foot_force: Maybe[];
  stability_margin: Maybe;
  roll: Maybe;
  pitch: Maybe;
}

export interface ServoStates {
  stamp_ns: number;
  /** °C; null not measured. */
  temperature: Maybe[];
  /** What is wrong with each, "" where it is well; [] from a body that can not tell. */
  faults: string[];
}

export interface GaitState {
  stamp_ns: number;
  gait: string;
  phase: Maybe[];
  swing: boolean[];
  parameters_frequency: Maybe;
  parameters_height: Maybe;
  parameters_stiffness: Maybe;
}

export interface LocomotionState {
  stamp_ns: number;
  posture: string;
  stability: "good" | "warn" | "slow" | "refuse";
  stability_margin: Maybe;
  energy_margin: Maybe;
  slipping: boolean[];
  leg_stages: string[];
  lift_margins: Maybe[];
  leg_posture: string;
}

export interface MotionOrders {
  stamp_ns: number;
  pose: Maybe[];
  automatic_posing: boolean;
  levelling: boolean;
  in_sequence: boolean;
  cruise_velocity: Maybe[];
  cruise_seconds_left: Maybe;
  held_legs: string[];
  held_tips: Maybe[][];
}

export interface GaitParameters {
  stamp_ns: number;
  virtual_stiffness: Maybe;
  stride_frequency: Maybe;
  stride_height: Maybe;
  confidence: Maybe;
}
export type ParameterName = "virtual_stiffness" | "stride_frequency" | "stride_height";

export interface AdaptationReport {
  stamp_ns: number;
  roughness: Maybe;
  roughness_sigma: Maybe;
  step_height: Maybe;
  step_height_sigma: Maybe;
  ahead_roughness: Maybe;
  ahead_step_height: Maybe;
  source: string;
  desired: GaitParameters;
  applied: GaitParameters;
  overridden: string[];
  preset: string;
  /** How the ground ahead is judged; "" while vision is silent. */
  perception: "" | "robust" | "paper";
}

export interface PowerState {
  stamp_ns: number;
  battery_voltage: Maybe;
  battery_fraction: Maybe;
  supply_power: Maybe;
  motor_power: Maybe;
  energy: Maybe;
  cost_of_transport: Maybe;
}

export interface LoopTiming {
  name: string;
  stamp_ns: number;
  rate: Maybe;
  period_error_p99: Maybe;
  overruns: number;
  cpu_fraction: Maybe;
  real_time_factor: Maybe;
}

export interface Health {
  stamp_ns: number;
  timings: LoopTiming[];
  odometry_quality: string;
  odometry_reason: string;
  odometry_age: Maybe;
  tracked_features: number;
  max_temperature: Maybe;
}

export interface Heartbeat {
  stamp_ns: number;
  sequence: number;
  session: string;
}

export interface EventMessage {
  stamp_ns: number;
  severity: Severity;
  source: string;
  text: string;
}

/** px of the picture of `stamp_ns`, from its upper left corner. */
export interface TrackedFeatures {
  stamp_ns: number;
  width: number;
  height: number;
  both_eyes: [x: number, y: number][];
  one_eye: [x: number, y: number][];
  rejected: [x: number, y: number][];
}

export interface CalibrationWish {
  what: string;
  met: boolean;
  advice: string;
}

export interface CalibrationMotion {
  kind: "turn" | "push";
  axis: "x" | "y" | "z";
  now: number;
  least: number;
  unit: string;
  seconds: number;
  wanted: number;
  met: boolean;
}

export interface CalibrationState {
  phase: "idle" | "starting" | "looking" | "solving" | "solved" | "failed";
  part: "cameras" | "imu";
  source: string;
  target: string;
  lenses: string;
  calibrations: string[];
  pictures: number;
  views: number;
  seconds: number;
  motions: CalibrationMotion[];
  seen: number[];
  cover: number[][][];
  wishes: CalibrationWish[];
  advice: string;
  step: string;
  usable: boolean;
  verdict: string;
  results: string[];
  files: string[];
  folder: string;
}

export interface RecordingEntry {
  name: string;
  started: string;
  seconds: number;
  size: number;
  pictures: boolean;
  whole: boolean;
}

export interface RecordingState {
  active: string;
  seconds: number;
  size: number;
  pictures: boolean;
  lost: number;
  reason: string;
  folder: string;
  free: number;
  entries: RecordingEntry[];
}

/** Where the replay of a recording is. */
export interface ReplayState {
  /** Recorded robot's clock. */
  stamp_ns: number;
  recording: string;
  robot_id: string;
  started: string;
  seconds: number;
  length: number;
  /** Recorded seconds a second; 0 paused. */
  speed: number;
}

export interface ReplayMark {
  seconds: number;
  severity: Severity;
  source: string;
  text: string;
}

export interface ReplayMarks {
  marks: ReplayMark[];
}

export interface TruthState {
  stamp_ns: number;
  position_in_world: Maybe[];
  wxyz: Maybe[];
  velocity_in_world: Maybe[];
}
