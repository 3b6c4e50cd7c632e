"""The gait follows the ground: soft, slow and high where it is rough or unknown, and never in jumps."""

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.adaptation import AdaptationController, ParameterOverrides, gait_for, safe_gait
from weaver_shared.config.adaptation import AdaptationConfig
from weaver_shared.errors import InputError
from weaver_shared.messages import TerrainEstimate

CONFIG = AdaptationConfig()
FLAT = {"virtual_stiffness": 2500.0, "stride_frequency": 1.0, "stride_height": 0.05}
ROUGH = {"virtual_stiffness": 400.0, "stride_frequency": 0.3, "stride_height": 0.14}
SECOND = 1_000_000_000
index = st.floats(0.0, 1.0)


@dataclass(frozen=True)
class Ground:
    roughness: float
    step_height: float
    roughness_sigma: float = 0.02
    step_height_sigma: float = 0.02


def seen(health=1.0):
    return TerrainEstimate(
        stamp_ns=0,
        roughness=0.1,
        roughness_sigma=0.02,
        step_height=0.1,
        step_height_sigma=0.02,
        features=np.zeros(7),
        plane_normal_in_world=np.array([0.0, 0.0, 1.0]),
        health=health,
        reason="",
    )


def settled(controller, ground, seconds=20, health=1.0, felt=None):
    for k in range(seconds * 10):
        report = controller.step(ground, seen(health), k * SECOND // 10, 0.1, felt)
    return report


def values(parameters):
    return {name: getattr(parameters, name) for name in FLAT}


def test_the_ends_of_the_polynomials_are_the_flat_and_the_rough_gait():
    assert gait_for(0.0, 0.0, CONFIG) == pytest.approx(FLAT)
    assert gait_for(1.0, 1.0, CONFIG) == pytest.approx(ROUGH)
    assert safe_gait(CONFIG) == pytest.approx(ROUGH)


@given(index, index, index)
def test_rougher_ground_never_makes_the_gait_stiffer_faster_or_lower(a, b, h):
    low, high = gait_for(min(a, b), h, CONFIG), gait_for(max(a, b), h, CONFIG)
    assert high["virtual_stiffness"] <= low["virtual_stiffness"] + 1e-9
    assert high["stride_frequency"] <= low["stride_frequency"] + 1e-12
    assert high["stride_height"] >= low["stride_height"] - 1e-12


@given(st.floats(allow_nan=True, allow_infinity=True), st.floats(allow_nan=True, allow_infinity=True))
def test_parameters_stay_within_bounds_whatever_the_ground(roughness, step_height):
    for name, value in gait_for(roughness, step_height, CONFIG).items():
        bounds = getattr(CONFIG, name)
        assert bounds.lower <= value <= bounds.upper


def test_a_robot_that_has_seen_nothing_walks_safely():
    report = AdaptationController().unknown(0, 0.1)
    assert values(report.applied) == pytest.approx(ROUGH)
    assert report.source == "none"
    assert report.desired.confidence == 0.0


def test_flat_ground_ends_in_the_flat_gait_and_rough_ground_in_the_rough_one():
    controller = AdaptationController()
    assert values(settled(controller, Ground(0.0, 0.0)).desired) == pytest.approx(FLAT)
    assert values(settled(controller, Ground(1.0, 1.0)).desired) == pytest.approx(ROUGH)


def test_unknown_ground_and_bad_pictures_lead_back_to_the_safe_gait():
    for ground, health in ((Ground(math.nan, math.nan), 1.0), (Ground(0.0, 0.0), 0.1)):
        controller = AdaptationController()
        settled(controller, Ground(0.0, 0.0))
        report = settled(controller, ground, health=health)
        assert values(report.desired) == pytest.approx(ROUGH)
        assert report.source == "none"


UNKNOWN = Ground(math.nan, math.nan, math.nan, math.nan)


def test_in_the_dark_the_feet_rule_and_count_with_their_doubt():
    report = settled(AdaptationController(), Ground(0.9, 0.9), health=0.1, felt=Ground(0.2, 0.1, 0.05, 0.03))
    assert report.source == "feet"
    assert (report.roughness, report.step_height) == pytest.approx((0.25, 0.13))
    assert values(report.desired) == pytest.approx(gait_for(0.25 + CONFIG.backlash, 0.13 + CONFIG.backlash, CONFIG))
    assert 0.0 < report.desired.confidence <= 0.5


def test_the_feet_are_not_asked_where_the_ground_under_them_was_seen():
    report = settled(AdaptationController(), Ground(0.1, 0.1), felt=Ground(0.9, 0.9))
    assert report.source == "vision"
    assert values(report.desired) == pytest.approx(gait_for(0.1 + CONFIG.backlash, 0.1 + CONFIG.backlash, CONFIG))


def test_where_the_ground_under_the_robot_was_never_seen_feet_and_the_view_ahead_rule_together():
    """The worse of what is felt and what is seen ahead (roughness and step height 0.1), each with its doubt."""
    report = settled(AdaptationController(), UNKNOWN, felt=Ground(0.05, 0.3, 0.01, 0.02))
    assert report.source == "feet"
    assert (report.roughness, report.step_height) == pytest.approx((0.12, 0.32))
    assert 0.0 < report.desired.confidence <= 0.5


def test_feet_alone_do_not_answer_for_ground_ahead_that_good_pictures_do_not_show():
    blank = dataclasses.replace(seen(), roughness=math.nan, step_height=math.nan)
    controller = AdaptationController()
    for k in range(100):
        report = controller.step(UNKNOWN, blank, k * SECOND // 10, 0.1, Ground(0.0, 0.0))
    assert report.source == "none"
    assert values(report.desired) == pytest.approx(ROUGH)


def test_ground_neither_seen_nor_felt_is_walked_on_safely():
    report = settled(AdaptationController(), Ground(0.0, 0.0), health=0.0, felt=UNKNOWN)
    assert report.source == "none"
    assert values(report.desired) == pytest.approx(ROUGH)


@given(st.lists(st.tuples(index, index, st.floats(0.01, 0.3)), min_size=1, max_size=30))
def test_no_parameter_changes_faster_than_its_rate(grounds):
    controller, last = AdaptationController(), safe_gait(CONFIG)
    for roughness, step_height, dt in grounds:
        now = values(controller.step(Ground(roughness, step_height), seen(), 0, dt).desired)
        for name in FLAT:
            assert abs(now[name] - last[name]) <= getattr(CONFIG, name).rate * dt * (1 + 1e-9)
        last = now


def test_noise_within_the_backlash_does_not_move_the_gait():
    controller = AdaptationController()
    before = values(settled(controller, Ground(0.5, 0.5)).desired)
    assert values(settled(controller, Ground(0.5 + 0.9 * CONFIG.backlash, 0.5)).desired) == before
    assert values(settled(controller, Ground(0.5 + 2.0 * CONFIG.backlash, 0.5)).desired) != before


def test_uncertain_ground_lowers_the_confidence():
    sure = settled(AdaptationController(), Ground(0.3, 0.3, 0.01, 0.01)).desired.confidence
    unsure = settled(AdaptationController(), Ground(0.3, 0.3, 0.2, 0.01)).desired.confidence
    assert unsure < sure <= 1.0


class TestOverrides:
    def report(self):
        return settled(AdaptationController(), Ground(0.0, 0.0))

    def test_an_override_is_reached_at_its_rate_and_handed_back_after_its_end(self):
        overrides, report = ParameterOverrides(), self.report()
        overrides.apply(report, 0)
        overrides.set("virtual_stiffness", 1000.0, 3 * SECOND)
        trace = [overrides.apply(report, k * SECOND // 100).applied.virtual_stiffness for k in range(1, 500)]
        assert trace[50] == pytest.approx(2500.0 - 1500.0 * 0.51, rel=0.02)
        assert trace[250] == 1000.0
        assert trace[-1] == 2500.0
        assert max(abs(np.diff(trace))) <= 15.0 + 1e-6

    def test_the_report_names_what_is_held(self):
        overrides = ParameterOverrides()
        overrides.set("stride_height", 0.1, SECOND)
        assert overrides.apply(self.report(), 0).overridden == ("stride_height",)
        overrides.clear("stride_height")
        assert overrides.apply(self.report(), 1).overridden == ()

    def test_the_desired_values_are_left_alone(self):
        overrides, report = ParameterOverrides(), self.report()
        overrides.set("stride_frequency", 0.4, 10 * SECOND)
        assert overrides.apply(report, 5 * SECOND).desired == report.desired

    @pytest.mark.parametrize("value", [399.0, 2501.0, math.nan, math.inf])
    def test_values_outside_the_range_are_refused_with_the_range(self, value):
        with pytest.raises(InputError, match="400 to 2500 N/m"):
            ParameterOverrides().set("virtual_stiffness", value, SECOND)

    def test_a_preset_changes_all_that_is_adapted_at_its_rate_and_within_its_range(self):
        overrides, report = ParameterOverrides(), self.report()
        assert overrides.apply(report, 0).preset == "usual"
        overrides.choose("careful")
        trace = [overrides.apply(report, k * SECOND // 100) for k in range(1, 600)]
        assert max(abs(np.diff([r.applied.stride_frequency for r in trace]))) <= 0.0035 + 1e-6
        applied = trace[-1].applied
        assert trace[-1].preset == "careful"
        assert trace[-1].desired == report.desired
        assert applied.virtual_stiffness == pytest.approx(0.8 * 2500.0)
        assert applied.stride_frequency == pytest.approx(0.6)
        assert applied.stride_height == pytest.approx(0.07)

    def test_a_preset_stays_within_the_range_and_an_override_beats_it(self):
        overrides, rough = ParameterOverrides(), settled(AdaptationController(), Ground(1.0, 1.0))
        overrides.choose("careful")
        overrides.set("stride_height", 0.06, 100 * SECOND)
        for k in range(1000):
            applied = overrides.apply(rough, k * SECOND // 100).applied
        assert (applied.virtual_stiffness, applied.stride_frequency) == (400.0, 0.3)
        assert applied.stride_height == pytest.approx(0.06)

    def test_an_unknown_preset_is_refused_with_the_known_ones(self):
        with pytest.raises(InputError, match="usual, careful"):
            ParameterOverrides().choose("reckless")

    def test_unknown_names_are_refused_with_the_known_ones(self):
        for act in (lambda o: o.set("colour", 1.0, 0), lambda o: o.clear("colour")):
            with pytest.raises(InputError, match="stride_frequency"):
                act(ParameterOverrides())
