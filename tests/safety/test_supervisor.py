"""Safety lets a healthy robot move, names every reason not to, and forgets a reason when its cause is gone."""

import dataclasses
from math import inf, nan, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.body import Trouble
from robot_agent.safety import SEVERITY, SafetyInputs, SafetySupervisor
from weaver_shared.config.safety import SafetyLimits
from weaver_shared.messages import SafetyAction

HEALTHY = SafetyInputs(
    stop_level="",
    upright=True,
    needs_odometry=True,
    operator_silence=0.1,
    attended=True,
    tilt=0.05,
    imu_age=0.0,
    odometry_age=0.05,
    odometry_lost=False,
    joints_missing=0.0,
    power_age=0.0,
    temperature=40.0,
    battery_voltage=26.0,
)


def verdict(**changes: object) -> tuple[SafetyAction, str]:
    result = SafetySupervisor().step(dataclasses.replace(HEALTHY, **changes), 0.01)
    return result.action, " | ".join(result.reasons)


def test_a_healthy_robot_may_move() -> None:
    result = SafetySupervisor().step(HEALTHY, 0.01)
    assert (result.action, result.reasons, result.warnings) == (SafetyAction.ALLOW, (), ())


@pytest.mark.parametrize(("imu_age", "known"), [(0.0, True), (0.05, True), (0.051, False), (0.3, False)])
def test_nothing_answers_to_an_attitude_older_than_50_ms(imu_age: float, known: bool) -> None:
    assert SafetySupervisor().step(dataclasses.replace(HEALTHY, imu_age=imu_age), 0.01).attitude_known is known


@pytest.mark.parametrize(
    ("changes", "action", "words"),
    [
        ({"stop_level": "settle"}, SafetyAction.SIT, "stopped by the operator"),
        ({"stop_level": "cut"}, SafetyAction.CUT, "torque is cut"),
        ({"operator_silence": 1.2}, SafetyAction.HOLD, "silent for 1.2 s"),
        ({"operator_silence": inf}, SafetyAction.HOLD, "no operator is in control"),
        ({"tilt": radians(40)}, SafetyAction.HOLD, "40 degrees"),
        ({"tilt": radians(70)}, SafetyAction.CUT, "fallen over"),
        ({"tilt": nan}, SafetyAction.HOLD, "attitude is unknown"),
        ({"imu_age": 0.3}, SafetyAction.HOLD, "IMU"),
        ({"odometry_age": 0.6}, SafetyAction.HOLD, "vision is silent"),
        ({"odometry_age": inf}, SafetyAction.HOLD, "vision is silent"),
        ({"odometry_lost": True}, SafetyAction.HOLD, "odometry is lost"),
        ({"joints_missing": 0.2}, SafetyAction.HOLD, "servo has not answered"),
        ({"temperature": 75.0}, SafetyAction.SIT, "75 degrees Celsius"),
        ({"battery_voltage": 23.0}, SafetyAction.SIT, "23.0 V"),
        ({"power_age": 6.0}, SafetyAction.SIT, "power monitor"),
        ({"battery_voltage": 20.9}, SafetyAction.SIT, "20.9 V"),
        ({"battery_voltage": 20.9, "upright": False}, SafetyAction.CUT, "20.9 V: empty"),
        ({"battery_voltage": 21.1, "upright": False}, SafetyAction.SIT, "21.1 V"),
        ({"troubles": (Trouble(text="a joint is stuck", action=SafetyAction.HOLD),)}, SafetyAction.HOLD, "stuck"),
        ({"troubles": (Trouble(text="no supply", action=SafetyAction.CUT),)}, SafetyAction.CUT, "no supply"),
    ],
)
def test_each_fault_has_its_consequence_and_its_words(
    changes: dict[str, object], action: SafetyAction, words: str
) -> None:
    found, reasons = verdict(**changes)
    assert found is action
    assert words in reasons


@pytest.mark.parametrize(
    "changes",
    [
        {"operator_silence": 0.75},
        {"tilt": 0.61},
        {"imu_age": 0.2},
        {"odometry_age": 0.5},
        {"joints_missing": 0.1},
        {"power_age": 5.0},
        {"temperature": 59.9},
        {"battery_voltage": 24.6},
    ],
)
def test_the_threshold_itself_is_still_allowed(changes: dict[str, object]) -> None:
    assert verdict(**changes) == (SafetyAction.ALLOW, "")


def test_just_below_the_cut_tilt_holds() -> None:
    assert verdict(tilt=1.05)[0] is SafetyAction.HOLD


@pytest.mark.parametrize(("field", "value"), [("temperature", 60.0), ("battery_voltage", 24.5)])
def test_warnings_do_not_restrict(field: str, value: float) -> None:
    result = SafetySupervisor().step(dataclasses.replace(HEALTHY, **{field: value}), 0.01)
    assert result.action is SafetyAction.ALLOW
    assert result.reasons == ()
    assert len(result.warnings) == 1


def test_a_seated_robot_needs_no_operator_and_a_resting_one_no_odometry() -> None:
    assert verdict(upright=False, operator_silence=inf)[0] is SafetyAction.ALLOW
    assert verdict(needs_odometry=False, odometry_age=inf, odometry_lost=True)[0] is SafetyAction.ALLOW


def test_a_minute_of_holding_ends_in_sitting_down() -> None:
    supervisor = SafetySupervisor()
    silent = dataclasses.replace(HEALTHY, operator_silence=inf)
    actions = [supervisor.step(silent, 1.0).action for _ in range(62)]
    assert actions[59] is SafetyAction.HOLD
    assert actions[60] is SafetyAction.SIT


def test_holding_is_counted_anew_after_the_cause_is_gone() -> None:
    supervisor = SafetySupervisor()
    silent = dataclasses.replace(HEALTHY, operator_silence=inf)
    for _ in range(50):
        supervisor.step(silent, 1.0)
    supervisor.step(HEALTHY, 1.0)
    assert all(supervisor.step(silent, 1.0).action is SafetyAction.HOLD for _ in range(60))


@pytest.mark.parametrize("change", [{"attended": False}, {"upright": False, "imu_age": 1.0}])
def test_waiting_for_the_first_operator_or_sitting_already_is_not_counted(change: dict[str, object]) -> None:
    supervisor = SafetySupervisor()
    waiting = dataclasses.replace(HEALTHY, operator_silence=inf, **change)
    assert all(supervisor.step(waiting, 1.0).action is SafetyAction.HOLD for _ in range(100))


def test_limits_are_settings() -> None:
    supervisor = SafetySupervisor(SafetyLimits(tilt_hold=0.2))
    assert supervisor.step(dataclasses.replace(HEALTHY, tilt=0.3), 0.01).action is SafetyAction.HOLD


def test_the_most_severe_reason_stands_first() -> None:
    _, reasons = verdict(operator_silence=inf, battery_voltage=20.0, tilt=radians(80))
    assert reasons.startswith("tilted")
    assert reasons.index("battery") < reasons.index("operator")


@given(
    stop_level=st.sampled_from(["", "settle", "cut"]),
    upright=st.booleans(),
    silence=st.floats(0, 5) | st.just(inf),
    tilt=st.floats(0, 3) | st.just(nan),
    temperature=st.floats(20, 90),
    voltage=st.floats(18, 30),
)
def test_adding_a_fault_never_makes_the_verdict_milder(
    stop_level: str, upright: bool, silence: float, tilt: float, temperature: float, voltage: float
) -> None:
    inputs = dataclasses.replace(
        HEALTHY,
        stop_level=stop_level,
        upright=upright,
        operator_silence=silence,
        tilt=tilt,
        temperature=temperature,
        battery_voltage=voltage,
    )
    before = SafetySupervisor().step(inputs, 0.01)
    after = SafetySupervisor().step(dataclasses.replace(inputs, imu_age=9.0, joints_missing=9.0), 0.01)
    assert SEVERITY[after.action] >= SEVERITY[before.action]
    assert (after.action is SafetyAction.ALLOW) == (after.reasons == ())


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"tilt": radians(40)}, "tilted by 40 degrees"),
        ({"tilt": radians(70)}, "tilted by 70 degrees: fallen over"),
        ({"imu_age": 0.3}, "the IMU has been silent for 0.3 s"),
        ({"joints_missing": 0.2}, "a servo has not answered for 0.2 s"),
        ({"temperature": 75.0}, "a servo is at 75 degrees Celsius"),
        ({"power_age": 6.0}, "the power monitor has been silent for 6 s"),
        ({"battery_voltage": 23.1}, "the battery is at 23.1 V"),
        ({"operator_silence": 1.2}, "the operator has been silent for 1.2 s"),
    ],
)
def test_a_reason_is_a_whole_sentence_with_its_unit(changes: dict[str, object], sentence: str) -> None:
    assert verdict(**changes)[1] == sentence


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"temperature": 60.0}, "a servo is at 60 degrees Celsius"),
        ({"battery_voltage": 24.5}, "the battery is at 24.5 V"),
    ],
)
def test_a_warning_is_a_whole_sentence_and_never_becomes_a_hold(changes: dict[str, object], sentence: str) -> None:
    supervisor = SafetySupervisor()
    for _ in range(100):
        result = supervisor.step(dataclasses.replace(HEALTHY, **changes), 1.0)
        assert (result.action, result.warnings) == (SafetyAction.ALLOW, (sentence,))


def test_what_ends_a_long_hold_is_said() -> None:
    supervisor = SafetySupervisor()
    silent = dataclasses.replace(HEALTHY, operator_silence=inf)
    assert [supervisor.step(silent, 1.0) for _ in range(61)][-1].reasons[0] == "held for 60 s"
