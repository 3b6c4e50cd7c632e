"""All that the walker knows, as one record of fixed layout.

Kernels take the whole record as a single argument (every further array costs a call a third of a microsecond) and
reach its parts by name, `walk.feet.place[leg]`. Room is for eight legs of six joints; `cut` gives Python the used
part of a field as an array that shares its memory.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from weaver_shared.config.locomotion import LocomotionConfig

Array = NDArray[Any]
Record = Any
"""A part of the walker's memory inside a kernel: its fields are attributes."""

LEGS, JOINTS, BEARINGS, LAYERS, PEAKS = 8, 6, 36, 3, 16
F, N = np.float64, np.int64

MODEL = np.dtype(
    [
        ("legs", N),
        ("joints", N),  # of a leg
        ("closed_form", N),  # see `kinematics.inverse`
        ("dh", F, (JOINTS, 6)),  # theta, d, r, alpha, cos alpha, sin alpha
        ("limits", F, (JOINTS, 2)),  # rad
        ("hips", F, (LEGS, 3)),  # m in body
        ("hip_axes", F, (LEGS, 3, 3)),
        ("link_mass", F, (JOINTS,)),  # kg
        ("speed_limit", F, (JOINTS,)),  # rad/s
        ("target_step", F, (JOINTS,)),  # rad, the most a servo turns in a tick without load
        ("servo_stiffness", F, (JOINTS,)),  # N m/rad
        ("servo_lag", F, (JOINTS,)),  # s, with the tick that the bus takes
        ("trunk_mass", F),  # kg
        ("trunk_centre", F, (3,)),  # m in body
        ("weight", F),  # N of the whole robot
        ("stance", F, (LEGS, 3)),  # m in body, middle of every foot's stance
        ("foot_depth", F),  # m of the stance under the body's origin
        ("radius", F, (LEGS, BEARINGS)),  # m of every leg's walkspace about its stance
        ("headroom", F, (LEGS,)),  # m that a foot can be lifted from its stance
        ("layers", F, (LAYERS,)),  # m above the stance, of the ground on which to walk
        ("farthest", F),  # m from the stance, up to which the workspace is searched
        ("safe_limits", F, (JOINTS, 2)),  # rad, with a margin
        ("standing", F, (JOINTS,)),  # rad, where the search for a posture begins
        ("reach", F),  # m, of the stretched leg
        ("down_limit", F),  # m, z in body between which footholds stay
        ("up_limit", F),
        ("dt", F),  # s, a tick
        ("force_blend", F),  # of the low-pass on the foot forces, a tick
        ("plane_blend", F),  # of that on the ground plane
    ]
)

ORDERS = np.dtype(
    [
        ("velocity", F, (3,)),  # vx, vy m/s, turn rad/s
        ("parameters", F, (3,)),  # frequency Hz, swing height m, stiffness N/m
        ("duty", F),
        ("offset", F, (LEGS,)),  # of the gait
        ("targeted", N, (LEGS,)),  # whether the next swing is to end at `target`
        ("target", F, (LEGS, 3)),  # m in the un-posed body
        ("posing_rotation", F, (3, 3)),  # unposed_from_body
        ("posing_position", F, (3,)),
        ("still_rotation", F, (3, 3)),  # the same without what moves with the gait
        ("still_position", F, (3,)),
    ]
)

READINGS = np.dtype(
    [
        ("joint_position", F, (LEGS * JOINTS,)),  # leg by leg, without gaps
        ("joint_torque", F, (LEGS * JOINTS,)),
        ("contact", N, (LEGS,)),
        ("gravity", F, (3,)),
    ]
)

SENSES = np.dtype(
    [
        ("joint_position", F, (LEGS, JOINTS)),  # last good readings
        ("joint_torque", F, (LEGS, JOINTS)),
        ("origins", F, (LEGS, JOINTS + 1, 3)),  # joints and foot, m in body
        ("axes", F, (LEGS, JOINTS, 3)),
        ("jacobian", F, (LEGS, 3, JOINTS)),
        ("own_torque", F, (LEGS, JOINTS)),  # N m that hold the links, and move them where contact is told by torque
        ("up", F, (3,)),  # in body, against gravity
        ("force", F, (LEGS,)),  # N along up, low-passed
        ("contact", N, (LEGS,)),
        ("contact_left", F, (LEGS,)),  # s that a contact still counts
        ("rate", F, (LEGS, JOINTS)),  # rad/s, wanted a tick ago
        ("inertia_torque", F, (LEGS, JOINTS)),  # N m that move the links, low-passed
        ("pressing", N, (LEGS,)),  # whether the torques tell of a foot on the ground
        ("centre_of_mass", F, (3,)),  # m in body
        ("unposed_up", F, (3,)),  # the same in the body as it would be without posing
        ("unposed_centre", F, (3,)),
        ("unposed_feet", F, (LEGS, 3)),
    ]
)

FEET = np.dtype(
    [
        ("mode", N, (LEGS,)),  # STAND, SWING, REACH, HANG of `feet`
        ("place", F, (LEGS, 3)),  # wanted foot centre, before the impedance
        ("lift_off", F, (LEGS, 3)),
        ("anchor", F, (LEGS, 3)),  # where each foot last stood, measured, carried along by the body's motion
        ("lifted", N, (LEGS,)),  # has already swung in this stride
        ("swing_height", F, (LEGS,)),
        ("planned", N, (LEGS,)),  # whether `foothold` is that of this swing
        ("foothold", F, (LEGS, 3)),  # m, where the swing ends
        ("aimed", N, (LEGS,)),  # whether this swing ends at `target`
        ("reached", F, (LEGS,)),  # m below the expected ground
        ("seeking", N, (LEGS,)),  # what a reaching foot does: see `ground_search`
        ("tried", N, (LEGS,)),  # places at which it has looked for ground in this swing
        ("goal", F, (LEGS, 2)),  # m in body, the next of them
        ("tripped", N, (LEGS,)),  # in this swing: see `trip`
        ("detour", F, (LEGS, 3)),  # m, from the swing's path to where the foot is led around what it struck
        ("stance", F, (LEGS, 3)),  # middle of every stance, shifted for the inclination
        ("in_air", np.uint8, (LEGS,)),  # a bool; numba has none in records
    ]
)

GAIT = np.dtype(
    [
        ("frequency", F),  # in use, after limits and rates
        ("height", F),
        ("stiffness", F),
        ("started", N),  # the parameters follow at a bounded rate from the first order on
        ("phase", F),
        ("duty", F),
        ("offset", F, (LEGS,)),
        ("leg_phase", F, (LEGS,)),  # 0 at lift-off
        ("gliding", F),  # 0..1, how fast offsets and duty go over to those of a newly chosen gait
        ("walking", N),
        ("halted", N),  # no foot lifts any more
        ("skipped", N),  # a foot has missed its lift-off, so the walk has to end before it goes on
        ("waited", F),  # s for a foot without ground
        ("pace", F),  # 1, less where the gait has to wait or the servos are too slow
        ("demand", F),  # fraction of its limit that the fastest joint needs at full pace, low-passed
        ("peaks", F, (PEAKS,)),  # the largest of it in every stretch of the last stride
        ("stretch", N),  # of the stride, under way
        ("freshest_peak", F),  # of that stretch
        ("stride_pace", F),  # 0..1, the pace that those peaks allow
        ("fastest", F),  # m/s, the largest speed at which the servos keep up
        ("limited", F, (3,)),  # the ordered velocity within the limits
        ("commanded", F, (3,)),  # after slewing
        ("velocity", F, (3,)),  # the same at the gait's present pace
    ]
)

SPACE = np.dtype(
    [
        ("reach", F, (LEGS, LAYERS, BEARINGS)),  # m, workspace about the stance at several heights
        ("middle", F, (LEGS, 3)),  # m in the posed body, the stance for which it holds
        ("moved", F, (LEGS,)),  # m from there to the stance of now
        ("leg", N),  # being renewed, -1 if none is
        ("ray", N),  # of its workspace, under way or the next
        ("ray_begun", N),  # whether it is under way
        ("begun", F, (3,)),  # m, its stance
        ("ray_begin", F, (3,)),  # m in the posed body, of the ray under way
        ("ray_along", F, (3,)),
        ("ray_joints", F, (JOINTS,)),  # rad, of the farthest place reached on it
        ("ray_progress", F, (3,)),  # see `workspace`
    ]
)

BODY = np.dtype(
    [
        ("plane", F, (3,)),  # z = a x + b y + c through the feet, low-passed
        ("shift", F, (2,)),  # m of the stance against gravity's inclination
        ("linear", F, (3,)),  # m/s of posture alone
        ("angular", F, (3,)),  # rad/s
        ("whole_linear", F, (3,)),  # with the walking, parallel to the ground
        ("whole_angular", F, (3,)),
    ]
)

LOAD = np.dtype(
    [
        ("share", F, (LEGS,)),  # 0..1 that a foot takes part
        ("load", F, (LEGS,)),  # N expected along up
        ("surplus", F, (LEGS,)),  # N felt beyond it
        ("offset", F, (LEGS, 2)),  # of the impedance: m along up and m/s
        ("step", F, (LEGS, 2, 3)),  # its discrete form for `stiffness`
        ("stiffness", F, (LEGS,)),  # N/m of each leg
    ]
)

POSING = np.dtype(
    [
        ("manual", F, (6,)),  # wanted, m and rad
        ("automatic", N),  # wanted, and planned for the gait
        ("levelling", N),  # wanted
        ("wanted", N),  # any of the three
        ("always", N),  # the gait is not walked without its automatic pose
        ("fade", F),  # 0..1, how much of that there is
        ("ahead", F),  # strides
        ("idle", N),  # nothing wanted, and nothing of an earlier order under way
        ("amplitude", F, (LEGS, 6)),  # of every leg's swing in the automatic pose
        ("slope", F, (6,)),  # steepest, per stride
        ("rates", F, (6,)),  # largest, m/s and rad/s
        ("steps", F, (3, 2)),  # the most that each of `pose_tick`'s slews goes in a tick, lengths and angles
        ("first", N),  # ticks over which a slew takes its first mean
        ("ticks", N, (3,)),
        ("still", N, (3,)),  # ticks since a slew was asked to move
        ("gains", F, (3,)),  # proportional, integral 1/s, derivative s of the levelling
        ("largest", F),  # rad, of the levelling
        ("rate_blend", F),  # of the low-pass on the tilt's rate, a tick
        ("measured", N),  # whether `tilt` holds
        ("tilt", F, (2,)),  # rad, of the last tick
        ("tilt_rate", F, (2,)),
        ("integral", F, (2,)),  # rad
        ("turn", F, (2,)),  # rad, the levelling's answer
    ]
)

JOINT = np.dtype(
    [
        ("foot", F, (LEGS, 3)),  # m in body, wanted
        ("previous", F, (LEGS, JOINTS)),
        ("wanted", F, (LEGS, JOINTS)),  # without the servos' lead
        ("target", F, (LEGS * JOINTS,)),  # with it, leg by leg, without gaps
        ("distance_left", F, (LEGS,)),  # m
    ]
)

ANSWER = np.dtype(
    [
        ("reasons", N),  # bits, see `reasons`
        ("static_margin", F),
        ("energy_margin", F),
        ("residual", F),  # m rms of the feet about the ground plane
        ("may_lift", N),  # whether the robot stands, so that `lift_margin` holds
        ("lift_margin", F, (LEGS,)),  # m, static, without each leg
        ("velocity", F, (3,)),  # the rest is copied here for whoever is told
        ("plane", F, (3,)),
        ("force", F, (LEGS,)),
        ("phase", F, (LEGS,)),
        ("posing_rotation", F, (3, 3)),
        ("posing_position", F, (3,)),
        ("foot", F, (LEGS, 3)),
        ("joint_position", F, (LEGS * JOINTS,)),
        ("swing", np.uint8, (LEGS,)),
        ("slipping", np.uint8, (LEGS,)),
    ]
)


SECTIONS = ("admittance", "posture", "foothold")
"""Of the configuration, what kernels read besides its plain numbers."""


def layout_of(settings: BaseModel) -> np.dtype[Any]:
    """The layout of a configuration: its numbers, switches and pairs of numbers, and its `SECTIONS`."""
    fields: list[Any] = []
    for name, value in settings:
        if isinstance(value, BaseModel):
            if name in SECTIONS:
                fields.append((name, layout_of(value)))
        elif isinstance(value, tuple):
            fields.append((name, F, (len(value),)))
        else:
            fields.append((name, N if isinstance(value, bool) else F))
    return np.dtype(fields)


def write(record: Record, settings: BaseModel) -> None:
    """Copy a configuration into its record."""
    for name, value in settings:
        if isinstance(value, BaseModel):
            if name in SECTIONS:
                write(record[name], value)
        else:
            record[name] = value


WALK = np.dtype(
    [
        ("model", MODEL),
        ("settings", layout_of(LocomotionConfig())),
        ("orders", ORDERS),
        ("readings", READINGS),
        ("senses", SENSES),
        ("feet", FEET),
        ("gait", GAIT),
        ("space", SPACE),
        ("body", BODY),
        ("load", LOAD),
        ("posing", POSING),
        ("joint", JOINT),
        ("answer", ANSWER),
    ]
)


class WalkState:
    """The memory of one walker; `memory` (1,) is what kernels take."""

    def __init__(self, legs: int, joints: int) -> None:
        self.memory = np.zeros(1, WALK)
        self.record = self.memory[0]
        begin = WALK.fields["answer"][1] if WALK.fields else 0
        self.answer = self.memory.view(np.uint8)[begin : begin + ANSWER.itemsize]
        self._size = {LEGS: legs, JOINTS: joints, JOINTS + 1: joints + 1, LEGS * JOINTS: legs * joints}

    def cut(self, part: str, field: str) -> Array:
        """The used part of a field, sharing memory: (legs, ...), (legs, joints, ...), (all joints,) or as it is."""
        whole: Array = self.record[part][field]
        return whole[tuple(slice(self._size.get(n, n)) for n in whole.shape)]
