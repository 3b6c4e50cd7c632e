"""What an operator asks of a robot, and the robot's answer."""

from dataclasses import dataclass, field
from enum import StrEnum

from weaver_shared.messages.estimation import Waypoint


class CommandName(StrEnum):
    TAKE_CONTROL = "take_control"
    RELEASE_CONTROL = "release_control"
    RETAIN_CONTROL = "retain_control"  # 4 Hz keep-alive of the lease, the operator's heartbeat
    STAND = "stand"
    SIT = "sit"  # name "pack": fold the legs away as well
    STOP = "stop"  # emergency stop; needs no lease; latches
    RELEASE_STOP = "release_stop"
    SET_MISSION = "set_mission"  # replaces the waypoints; does not start; name "auto": find the way
    START_MISSION = "start_mission"
    PAUSE_MISSION = "pause_mission"
    CLEAR_MISSION = "clear_mission"
    SET_AREAS = "set_areas"  # replaces the forbidden areas; waypoints: their corners; name: how many each has, "4 3"
    SKIP_WAYPOINT = "skip_waypoint"  # leave out the one being approached
    RETURN_TO_START = "return_to_start"  # walk back to where the mission began, through the waypoints reached
    SET_OVERRIDE = "set_override"  # name, value, seconds
    CLEAR_OVERRIDE = "clear_override"  # name
    SET_PRESET = "set_preset"  # name of a preset of the adaptation
    SET_PERCEPTION = "set_perception"  # name: robust, paper; how the ground ahead is judged
    SET_GAIT = "set_gait"  # name
    START_CRUISE = "start_cruise"  # name: forward, left (m/s), turn (rad/s), value; or stick: as it is now; seconds
    STOP_CRUISE = "stop_cruise"
    SET_START_UP = "set_start_up"  # name: direct, sequence; how to stand up and sit down
    CHANGE_POSTURE = "change_posture"  # name of the posture the legs go into, one after the other, while it stands
    SET_POSE = "set_pose"  # name: x, y, z (m), roll, pitch, yaw (rad); value
    CLEAR_POSE = "clear_pose"  # name of one axis, or none for all
    LIFT_LEG = "lift_leg"  # name of a leg: take it off the ground, into the operator's hands
    LOWER_LEG = "lower_leg"  # name of a leg, or none for all
    MOVE_TIP = "move_tip"  # name: LEG.x, LEG.y, LEG.z; value m in body from where it was lifted to
    MOVE_JOINT = "move_joint"  # name: LEG_joint; value rad
    PLACE_FOOT = "place_foot"  # name: LEG.world, LEG.body; one waypoint x, y and value z (m): its next swing; seconds
    SET_POSING = "set_posing"  # name: automatic, levelling; value 1 or 0
    LOOK_CLOSELY = "look_closely"  # the next picture in full resolution into the map; the vision loop's, needs no lease
    START_RECORDING = "start_recording"  # value 1: with the stereo pictures, 0: without; the recorder's, needs no lease
    STOP_RECORDING = "stop_recording"  # the recorder's, needs no lease
    START_REPLAY = "start_replay"  # name of a recording; the recorder's, needs no lease
    PLAY_REPLAY = "play_replay"  # value: recorded s a second, 0 to pause; of a replay, needs no lease
    JUMP_REPLAY = "jump_replay"  # value: s from the recording's beginning; likewise
    END_REPLAY = "end_replay"  # likewise
    START_CALIBRATION = "start_calibration"  # name: [imu] TARGET [with CALIBRATION] [from RECORDING]; needs no lease
    SOLVE_CALIBRATION = "solve_calibration"  # name of the lens model: radtan, equidistant; likewise
    END_CALIBRATION = "end_calibration"  # likewise


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """One request. The robot refuses a stale epoch or a sequence number it has already seen from that operator."""

    command: CommandName
    operator: str
    lease_epoch: int
    sequence: int
    name: str = ""
    value: float = 0.0
    seconds: float = 0.0
    reason: str = ""
    waypoints: tuple[Waypoint, ...] = field(default=())


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """`accepted` with what was really applied and perhaps a remark, or refused with a reason; both for a person."""

    accepted: bool
    reason: str
    lease_epoch: int = 0
    applied_value: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class TeleopFrame:
    """A stick position; without a fresh one for 0.3 s the robot ramps to zero."""

    operator: str
    lease_epoch: int
    sequence: int
    dead_man: bool
    forward: float  # -1..1 of the robot's limits
    left: float
    turn: float
