"""In physics: the walker stands a robot up, walks it where it is told, and stops, without seeing the truth."""

import numpy as np
import pytest

pytest.importorskip("pybullet")

from robot_agent.body import JointTargets
from robot_agent.locomotion import Walker, WalkInput
from sim_agent.body import SimulatedBody
from sim_agent.worlds import make_world
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot

DOWN = np.array([0.0, 0.0, -1.0])


def test_it_stands_walks_half_a_metre_and_stops_on_flat_ground():
    robot = load_robot("weaver")
    body = SimulatedBody(robot, make_world("flat", 1), 1)
    walker = Walker(robot)
    parameters = GaitParameters(
        stamp_ns=0, virtual_stiffness=2500.0, stride_frequency=0.9, stride_height=0.05, confidence=1.0
    )
    torque_limit = np.tile([robot.servos[joint.servo].stall_torque for joint in robot.joints], robot.leg_count)
    begun, walked, heights, weight = False, [], [], 0.0
    for tick in range(700):
        stamp_ns = body.wait_next()
        sensed = body.read()
        if not begun:
            walker.reset(sensed.joint_position)
            begun = True
        out = walker.step(
            WalkInput(
                stamp_ns=stamp_ns,
                velocity=np.array([0.2, 0.0, 0.0]) if 350 <= tick < 600 else np.zeros(3),
                parameters=parameters,
                gait="tripod",
                stand=True,
                joint_position=sensed.joint_position,
                joint_torque=sensed.joint_torque,
                foot_contact=sensed.foot_contact,
                gravity_in_body=DOWN,
            )
        )
        body.write(
            JointTargets(stamp_ns=stamp_ns, position=out.joint_position, torque_limit=torque_limit, torque_on=True)
        )
        weight = out.foot_force.sum() if tick == 345 else weight
        truth = body.truth()
        walked.append(truth.position_in_world[0])
        heights.append(truth.position_in_world[2])
    still = np.ptp(walked[660:])
    body.close()
    assert out.posture == "standing"
    assert walked[-1] == pytest.approx(0.2 * 2.5, rel=0.12)
    assert still < 1e-3
    assert np.mean(heights[340:350]) == pytest.approx(robot.clearance, abs=0.003)
    assert min(heights[350:]) > robot.clearance - 0.02
    assert weight == pytest.approx(robot.mass * 9.81, rel=0.05)
