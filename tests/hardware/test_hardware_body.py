"""A body on servos: soft starts, what it believes, and what it does when servos, wires or time fail it.

Detection times are of the bus's own clock; 10 ms are one tick.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hardware_bodies import Twin, order

from robot_agent.hardware.joint_watch import JointState
from robot_agent.hardware.servos import preparation
from robot_agent.hardware.servos import registers as r
from robot_agent.hardware.servos.health_block import indirect_addresses
from sim_agent.servo_bus.servo import OVERLOADED
from weaver_shared.config.hardware import ServoSettings
from weaver_shared.errors import ResourceError

Make = Callable[..., Twin]


def ticks_until(twin: Twin, condition: Callable[[], object], most: int = 60) -> int:
    for tick in range(1, most + 1):
        twin.run(1)
        if condition():
            return tick
    raise AssertionError(f"not within {most} ticks; troubles are {twin.body.troubles()}")


def all_hold(twin: Twin) -> bool:
    return all(servo.table[r.TORQUE_ENABLE] for servo in twin.servos.servos)


@pytest.fixture
def twin(make_twin: Make) -> Twin:
    """Holding its posture with torque, all well."""
    made = make_twin()
    made.run(20)
    assert made.body.watch.valid.all()
    assert all_hold(made)
    return made


def test_torque_comes_softly_and_goals_start_where_the_joints_are(make_twin: Make) -> None:
    twin = make_twin(ServoSettings(start_time=0.6))
    twin.body.wait_next()
    start = twin.body.read().joint_position
    twin.wanted = start + 0.3
    twin.run(1)
    femur = twin.servos.servos[2]
    assert femur.table[r.GOAL_POSITION] == pytest.approx(femur.table[r.PRESENT_POSITION], abs=8)
    highest = twin.wiring.current(np.full(30, 6.0), np.arange(30))[2]
    assert femur.table[r.GOAL_CURRENT] == pytest.approx(0.31 * highest, rel=0.03)
    twin.run(20)
    moved = twin.body.read().joint_position - start
    assert 0.05 < moved[2] < 0.22  # 1 rad/s
    twin.run(60)
    assert femur.table[r.GOAL_CURRENT] == highest
    assert twin.body.read().joint_position[2] - start[2] == pytest.approx(0.3, abs=0.03)


def test_the_bus_carries_what_it_can_in_a_tick(make_twin: Make) -> None:
    """30 servos on two buses at 3 Mbit/s: 3.3 ms computed for question, answers and adapter."""
    twin = make_twin()
    twin.run(5)
    begin = twin.body.wait_next()
    assert (twin.clock.now_ns() - begin) * 1e-9 < 3.6e-3


def test_answers_lost_now_and_then_are_only_marked(twin: Twin) -> None:
    for bus in twin.servos.buses.values():
        bus.troubles.lost_answers = 0.02
    missing = []
    for _ in range(100):
        twin.run(1)
        missing.append(int((~twin.body.watch.valid).sum()))
        assert not (twin.body.watch.state == JointState.LOST).any()
    assert 20 < sum(missing) < 110
    age = twin.clock.now_ns() - twin.body.watch.believed_ns
    assert age.max() < 50_000_000


def test_a_servo_on_a_bad_wire_is_the_only_one_missing(twin: Twin) -> None:
    bus = twin.servos.buses["right"]
    bus.troubles.spoilt_answers, bus.troubles.spoilt_ids = 1.0, frozenset({3})
    twin.run(1)
    assert list(np.flatnonzero(~twin.body.watch.valid)) == [2]
    bus.troubles.spoilt_answers = 0.0
    twin.run(1)
    assert twin.body.watch.valid.all()


def test_lost_questions_cost_a_cycle_of_that_bus(twin: Twin) -> None:
    twin.servos.buses["left"].troubles.lost_questions = 1.0
    twin.run(1)
    assert list(np.flatnonzero(~twin.body.watch.valid)) == list(range(15, 30))
    twin.servos.buses["left"].troubles.lost_questions = 0.0
    twin.run(1)
    assert twin.body.watch.valid.all()


def test_a_servo_that_is_gone_is_named_and_no_longer_waited_for(twin: Twin) -> None:
    twin.servos.servos[6].alive = False
    assert ticks_until(twin, lambda: twin.body.watch.state[6] == JointState.LOST) == 5
    assert twin.body.troubles() == ["servo BR_roll does not answer"]
    begin = twin.body.wait_next()
    assert (twin.clock.now_ns() - begin) * 1e-9 < 3.6e-3
    assert int(twin.body.watch.valid.sum()) == 29
    twin.servos.servos[6].alive = True
    twin.run(60)
    assert twin.body.watch.valid.all()


@pytest.mark.parametrize("fault", ["overload", "heat"])
def test_a_shutdown_is_seen_in_the_same_cycle(twin: Twin, fault: str) -> None:
    servo = twin.servos.servos[7]
    if fault == "overload":
        servo.fail(OVERLOADED)
    else:
        servo.temperature = 85.0
    assert ticks_until(twin, lambda: twin.body.watch.state[7] == JointState.SHUT_DOWN) == 1
    assert not twin.body.watch.valid[7]
    assert twin.body.troubles()[0].startswith("servo BR_femur has shut down: over")
    told = twin.body.joint_faults()
    assert told[7].startswith("has shut down: over")
    assert [joint for joint, fault in enumerate(told) if fault] == [7]
    others = [s for s in twin.servos.servos if s is not servo]
    assert all(s.table[r.TORQUE_ENABLE] for s in others)


def test_a_servo_that_lost_power_for_a_moment_is_not_believed_until_made_ready(twin: Twin) -> None:
    twin.servos.servos[7].restart(twin.clock.now_ns())
    ticks_until(twin, lambda: twin.body.watch.state[7] == JointState.RESET, 100)
    assert not twin.body.watch.valid[7]
    twin.run(100)
    assert not twin.body.watch.valid[7]
    for _ in range(10):
        twin.body.wait_next()
        twin.body.write(order(twin.wanted, on=False))
    twin.body.recover()
    twin.run(20)
    assert twin.body.watch.valid.all()


def test_torque_stays_off_while_a_servo_is_missing(make_twin: Make) -> None:
    twin = make_twin()
    twin.servos.servos[0].alive = False
    twin.run(20)
    assert not any(servo.table[r.TORQUE_ENABLE] for servo in twin.servos.servos)
    assert "torque stays off until every servo is well" in twin.body.troubles()


def test_when_control_stalls_the_servos_stop_by_themselves_and_then_go_on_slowly(twin: Twin) -> None:
    twin.clock.forward(seconds=0.25)
    begin = twin.clock.now_ns()
    twin.body.wait_next()
    assert (twin.body.watch.state == JointState.STOPPED).all()
    assert twin.clock.now_ns() - begin < 10_000_000
    assert all_hold(twin)
    held = twin.body.read().joint_position
    twin.wanted = held + 0.2
    twin.run(4)
    assert twin.body.watch.valid.all()
    assert all_hold(twin)
    assert np.abs(twin.body.read().joint_position - held).max() < 0.2
    twin.run(60)
    assert np.abs(twin.body.read().joint_position - twin.wanted)[2::5].max() < 0.05


def test_an_unplugged_bus_is_known_at_once_and_taken_up_again(twin: Twin) -> None:
    twin.ports["left"].plugged = False
    twin.run(1)
    assert any("is down" in text for text in twin.body.troubles())
    assert list(np.flatnonzero(twin.body.watch.valid)) == list(range(15))
    twin.run(60)
    assert all_hold(twin)
    twin.ports["left"].plugged = True
    twin.run(80)
    assert twin.body.watch.valid.all()
    assert not twin.body.troubles()


def test_an_angle_that_can_not_be_is_not_passed_on(twin: Twin) -> None:
    """An encoder that jumps by a radian; a servo turns 0.25 rad in a tick at the very most."""
    before = twin.body.read().joint_position[3]
    servo = twin.servos.servos[3]
    original = servo.feel
    servo.feel = lambda **felt: original(**felt | {"position": felt["position"] + 1.0})
    assert ticks_until(twin, lambda: twin.body.watch.state[3] == JointState.JUMPED) <= 2
    assert twin.body.read().joint_position[3] == pytest.approx(before, abs=0.01)
    servo.feel = original
    twin.run(2)
    assert twin.body.watch.valid.all()


def test_stuffed_values_are_read_right(twin: Twin) -> None:
    servo = twin.servos.servos[1]
    original = servo.feel
    servo.feel = lambda **felt: original(
        position=felt["position"], velocity=-3 * r.VELOCITY_UNIT, current=-1 * r.CURRENT_UNIT
    )
    twin.run(2)
    sign = -1.0
    assert twin.body.watch.valid.all()
    assert twin.body.read().joint_velocity[1] == pytest.approx(-3 * sign * r.VELOCITY_UNIT)


def test_a_wrong_model_is_refused_by_name(make_twin: Make) -> None:
    twin = make_twin()
    twin.servos.servos[2].table[r.MODEL_NUMBER] = 311
    with pytest.raises(ResourceError, match=r"AR_femur.*is MX-64 where the robot has MX-106"):
        twin.body.prepare()


def test_a_servo_that_does_not_show_what_it_has_to_is_refused(make_twin: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    twin = make_twin()
    eeprom = r.ID.address.to_bytes(2, "little")
    monkeypatch.setattr(preparation, "indirect_addresses", lambda: eeprom + indirect_addresses()[2:])
    with pytest.raises(ResourceError, match=r"AR_yaw.* refuses the places of its answer at address 168 \(error 4\)"):
        twin.body.prepare()


def test_a_servo_that_answers_reads_alone_is_made_to_answer_all(make_twin: Make) -> None:
    twin = make_twin()
    servo = twin.servos.servos[3]
    servo.table[r.STATUS_RETURN_LEVEL] = 1
    twin.body.prepare()
    assert servo.table[r.STATUS_RETURN_LEVEL] == r.ANSWERS_ALL


def test_old_firmware_is_refused(make_twin: Make) -> None:
    twin = make_twin()
    twin.servos.servos[0].table[r.FIRMWARE] = 36
    with pytest.raises(ResourceError, match="firmware 36"):
        twin.body.prepare()


def test_a_new_program_takes_over_servos_that_hold(twin: Twin) -> None:
    """As after a crash: torque never goes, goals are where the joints are, and motion begins slowly."""
    twin.clock.forward(seconds=1.0)
    assert all(servo.table[r.TORQUE_ENABLE] for servo in twin.servos.servos)
    held = twin.servos.joints.body.read().joint_position.copy()
    body, _ = twin.servos.in_process(twin.clock)
    body.prepare()
    assert all_hold(twin)
    twin.body = body
    twin.wanted = held
    twin.run(20)
    assert body.watch.valid.all()
    assert np.abs(body.read().joint_position - held).max() < 0.03


def test_an_order_without_torque_is_the_only_thing_that_takes_it(twin: Twin) -> None:
    twin.body.wait_next()
    twin.body.write(order(twin.wanted, on=False))
    twin.body.wait_next()
    assert not any(servo.table[r.TORQUE_ENABLE] for servo in twin.servos.servos)
