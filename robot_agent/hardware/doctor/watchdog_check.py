"""Whether servos stop by themselves, and hold, when the computer falls silent. The robot must hang: torque comes on."""

from __future__ import annotations

import numpy as np

from robot_agent.body import JointTargets
from robot_agent.hardware.doctor.finding import Finding, Verdict, named, not_tested
from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.joint_watch import JointState
from robot_agent.hardware.servos.port import LineClock

CHECK = "watchdog"
HOLDING_TICKS = 30
TORQUE_SHARE = 0.3
"""Of each servo's stall torque: bears a hanging leg."""
STILL = 0.05  # rad
GRACE = 0.06  # s beyond the watchdog's time


def judge_watchdog(body: HardwareBody, clock: LineClock, watchdog: float) -> Finding:
    """Hold, fall silent for longer than `watchdog` s, look, and let go. Leaves torque off, whatever happens."""
    robot = body.robot
    stall = np.tile([robot.servos[joint.servo].stall_torque for joint in robot.joints], robot.leg_count)
    body.wait_next()
    wanted = body.read().joint_position

    def order(*, on: bool) -> JointTargets:
        return JointTargets(stamp_ns=0, position=wanted, torque_limit=TORQUE_SHARE * stall, torque_on=on)

    if not body.watch.valid.all():
        return not_tested(CHECK, "not every servo is well", "mend what is said above")
    try:
        for _ in range(HOLDING_TICKS):
            body.write(order(on=True))
            body.wait_next()
        held = body.read().joint_position
        clock.sleep_until(clock.now_ns() + round((watchdog + GRACE) * 1e9))
        body.wait_next()
        return _judged(body, held, watchdog)
    finally:
        body.write(order(on=False))


def _judged(body: HardwareBody, held: np.ndarray, watchdog: float) -> Finding:
    names, watch = body.robot.joint_names, body.watch
    asleep = [names[joint] for joint in np.flatnonzero(watch.state != JointState.STOPPED)]
    limp = [names[joint] for joint in np.flatnonzero(body.exchange.block["torque_on"] == 0)]
    gave_way = [names[joint] for joint in np.flatnonzero(np.abs(watch.position - held) > STILL)]
    fixes = []
    if asleep:
        fixes.append(f"{named(asleep)} did not notice: update the firmware, and do not walk before this is good")
    if limp or gave_way:
        fixes.append(f"{named(limp or gave_way)} did not hold: see that its homing offset is 0 and update its firmware")
    stopped = len(names) - len(asleep)
    return Finding(
        check=CHECK,
        verdict=Verdict.WRONG if fixes else Verdict.GOOD,
        found=f"{stopped} of {len(names)} servos stopped after {watchdog:g} s of silence"
        + (" and held" if not fixes else ""),
        fix="; ".join(fixes),
        figures={"stopped": stopped, "not_stopped": asleep, "without_torque": limp, "moved": gave_way},
    )
