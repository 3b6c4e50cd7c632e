"""The fit finds the gaits that made-up trials favour, is honest about grounds nothing passed, and can be resumed."""

import json
import tomllib
from dataclasses import replace
from importlib import resources

import numpy as np
import pytest

from robot_agent.adaptation import gait_for, safe_gait
from sim_agent.command_line import study_fit
from sim_agent.fit_study.best import GOOD, best_gait, score
from sim_agent.fit_study.fragment import write_fragment
from sim_agent.fit_study.grounds import GROUNDS, measured_section, true_indices
from sim_agent.fit_study.least_squares import adapted, fit
from sim_agent.fit_study.plan import grounds_named, trials, widened
from sim_agent.fit_study.refinement import refined
from sim_agent.fit_study.store import TrialStore
from sim_agent.fit_study.trial import TrialResult, walk_trial
from weaver_shared.config.adaptation import AdaptationConfig
from weaver_shared.errors import InputError
from weaver_shared.robots import load_robot
from weaver_shared.robots.catalogue import robot_of

ROBOT = load_robot()
USED = widened(ROBOT)
TRUE = USED.model_copy(
    update={
        "stiffness_polynomial": (2000.0, -1500.0, 0.0, 0.0),
        "frequency_polynomial": (0.9, -0.6, 0.0),
        "height_polynomial": (0.06, 0.05, 0.03),
    }
)
INDICES = {"level": (0.0, 0.0), "sand": (0.3, 0.15), "stones": (0.4, 0.45), "rubble": (0.6, 0.3), "broken": (0.8, 0.5)}


def made_up_trial(trial, ideal=TRUE):
    """Costs least where the parameters are those of `ideal`; soft ground that is walked fast is not passed."""
    wanted = gait_for(*INDICES[trial.ground], ideal)
    off = 0.0
    for name in ("virtual_stiffness", "stride_frequency", "stride_height"):
        bounds = getattr(USED, name)
        off += ((getattr(trial, name) - wanted[name]) / (bounds.upper - bounds.lower)) ** 2
    return TrialResult(
        trial=trial,
        outcome="reached",
        speed=0.2 * trial.stride_frequency,
        cost_total=8.0 * (1.0 + 0.6 * off),
        cost_motors=4.0,
        roll_variance=0.0,
        pitch_variance=0.0,
    )


def bests_of(quick=False):
    results = [
        made_up_trial(one) for one in trials("weaver", USED, grounds_named("", quick=True), range(1), quick=quick)
    ]
    return [
        best_gait(name, INDICES[name], [result for result in results if result.trial.ground == name])
        for name in INDICES
    ]


def test_the_study_looks_beyond_the_bounds_in_use():
    default = ROBOT.model_copy(update={"adaptation": AdaptationConfig()})
    assert widened(default).stride_frequency.upper == ROBOT.locomotion.frequency_bounds[1]
    assert widened(default).stride_height.lower < default.adaptation.stride_height.lower
    assert widened(ROBOT) == widened(ROBOT.model_copy(update={"adaptation": widened(ROBOT)}))
    tried = trials("weaver", USED, grounds_named("", quick=True), range(1), quick=True)
    assert len(tried) == 120
    assert max(one.stride_frequency for one in tried) == 1.5
    assert min(one.stride_height for one in tried) == 0.03


def test_the_studied_grounds_span_roughness_and_step_height():
    found = {ground.name: true_indices(ground.world(ROBOT)) for ground in GROUNDS}
    assert found["level"] == pytest.approx((0.0, 0.0), abs=1e-6)
    roughness = [found[name][0] for name in ("level", "gravel", "sand", "stones", "rubble", "broken", "boulders")]
    assert np.all(np.diff(roughness) > 0.02)
    assert roughness[-1] > 0.7
    assert found["boulders"][1] > 0.4


def test_seeds_differ_in_the_start_alone():
    ground = GROUNDS[3]
    first, second = ground.world(ROBOT, 1), ground.world(ROBOT, 2)
    assert first.start != second.start
    x = np.linspace(0.0, 2.0, 50)
    np.testing.assert_array_equal(first.elevation(x, 0.1), second.elevation(x, 0.1))


def test_a_level_ground_is_walked_and_judged():
    flat = trials("weaver", USED, grounds_named("level", quick=True), range(1, 2), quick=True)
    quick_one = next(one for one in flat if one.parameters == (2500.0, 1.1, 0.03))
    result = walk_trial(quick_one)
    begin, end = measured_section()
    assert result.outcome == "reached"
    assert 0.15 < result.speed < 0.35
    assert 3.0 < result.cost_motors + 1.0 < result.cost_total < 10.0
    assert result.roll_variance + result.pitch_variance < np.deg2rad(1.0) ** 2
    assert end - begin > 1.0


def test_the_best_gait_is_the_mean_of_the_good_sets():
    (_, _, _, rubble, _) = bests_of()
    wanted = gait_for(*INDICES["rubble"], TRUE)
    assert rubble.passed == rubble.sets == 80
    assert rubble.parameters[1] == pytest.approx(wanted["stride_frequency"], abs=0.06)
    assert rubble.parameters[2] == pytest.approx(wanted["stride_height"], abs=0.012)
    assert rubble.fastest[1] == USED.stride_frequency.upper


def test_a_set_that_fails_with_one_seed_is_out():
    one, *_ = trials("weaver", USED, grounds_named("sand", quick=True), range(1), quick=True)
    good = made_up_trial(one)
    other = made_up_trial(replace(one, stride_frequency=0.65))
    fell = replace(good, trial=replace(one, seed=1), outcome="fell", cost_total=float("nan"))
    assert best_gait("sand", (0.3, 0.2), [good, fell, other]).parameters[1] == 0.65
    nothing = best_gait("sand", (0.3, 0.2), [fell])
    assert (nothing.passed, nothing.sets) == (0, 1)
    assert np.isnan(nothing.parameters).all()


def test_the_search_goes_on_halfway_to_the_neighbours_of_the_best_set():
    tried = trials("weaver", USED, grounds_named("rubble", quick=True), range(2), quick=True)
    best = best_gait("rubble", INDICES["rubble"], map(made_up_trial, tried))
    (c, f, h), lowest = best.lowest, best.score
    closer = refined(best.lowest, tried)
    assert {trial.seed for trial in closer} == {0, 1}
    for trial in closer:
        changed = [new != old for new, old in zip(trial.parameters, (c, f, h), strict=True)]
        assert sum(changed) == 1
        assert 400.0 <= trial.virtual_stiffness <= 2500.0
    assert {round(abs(trial.stride_frequency - f), 6) for trial in closer} == {0.0, 0.2}
    again = best_gait("rubble", INDICES["rubble"], map(made_up_trial, [*tried, *closer]))
    assert again.score < lowest
    assert not {trial.parameters for trial in refined(again.lowest, [*tried, *closer])} & {t.parameters for t in tried}


def test_where_nothing_passed_there_is_nothing_to_search_closer():
    tried = trials("weaver", USED, grounds_named("sand", quick=True), range(1), quick=True)
    failed = best_gait("sand", (0.3, 0.2), [replace(made_up_trial(tried[0]), outcome="fell")])
    assert refined(failed.lowest, tried) == []


def test_sway_makes_a_cheap_walk_a_poor_one():
    assert score(8.0, np.deg2rad(3.0) ** 2) == pytest.approx(16.0)
    assert score(8.0, 0.0) == 8.0
    assert 0.0 < GOOD < 0.2


def test_the_polynomials_behind_the_trials_are_found_again():
    found = adapted(USED, fit(bests_of(), USED))
    for name, (r, h) in INDICES.items():
        new, true = gait_for(r, h, found), gait_for(r, h, TRUE)
        assert new["stride_frequency"] == pytest.approx(true["stride_frequency"], abs=0.1), name
        assert new["stride_height"] == pytest.approx(true["stride_height"], abs=0.02), name
        assert new["virtual_stiffness"] == pytest.approx(true["virtual_stiffness"], rel=0.35), name


def test_unknown_ground_keeps_the_safe_gait():
    for bests in (bests_of(), bests_of()[:2]):
        found = safe_gait(adapted(USED, fit(bests, USED)))
        for name, value in safe_gait(USED).items():
            assert found[name] == pytest.approx(value, rel=0.05), name


def test_the_polynomials_never_turn_with_rougher_ground():
    """Made-up bests with a hump, such as a few grounds of their own kind make it: a line falls through them."""
    humped = [
        replace(best, parameters=(2000.0 - 6000.0 * r + 6000.0 * r**2, 0.9 + 1.2 * r - 1.8 * r**2, 0.09 - 0.05 * r))
        for best in bests_of()
        for r in [best.roughness]
    ]
    found = adapted(USED, fit(humped, USED))
    answers = [gait_for(r, r, found) for r in np.linspace(0.0, 1.0, 21)]
    for name, sign in (("virtual_stiffness", -1), ("stride_frequency", -1), ("stride_height", 1)):
        steps = np.diff([answer[name] for answer in answers])
        assert (sign * steps >= -1e-12).all(), name


def test_grounds_that_nothing_passed_do_not_enter_the_fit():
    *most, last = bests_of()
    failed = best_gait("broken", (last.roughness, last.step_height), [])
    assert fit([*most, failed], USED) == fit(most, USED)


def test_the_fragment_is_a_section_of_a_robot_description(tmp_path):
    settings = adapted(USED, fit(bests_of(), USED))
    write_fragment(tmp_path / "adaptation.toml", settings, "weaver")
    text = (tmp_path / "adaptation.toml").read_text()
    assert AdaptationConfig(**tomllib.loads(text)["adaptation"]) == settings
    own = tmp_path / "robot.toml"
    shipped = (resources.files("weaver_shared.robots") / "weaver.toml").read_text()
    own.write_text(shipped.partition("[adaptation]")[0] + text)
    assert robot_of(own.read_text(), "robot.toml").adaptation == settings


def test_trials_are_found_again_and_only_for_their_own_plan(tmp_path):
    one, *_ = trials("weaver", USED, grounds_named("sand", quick=True), range(1), quick=True)
    fell = replace(made_up_trial(one), outcome="fell", cost_total=float("nan"))
    TrialStore(tmp_path).save(fell)
    found = TrialStore(tmp_path).load(one)
    assert (found.outcome, found.trial) == ("fell", one)
    assert np.isnan(found.cost_total)
    assert TrialStore(tmp_path).load(replace(one, seed=9)) is None
    (tmp_path / "trials.parquet").write_bytes(b"PAR1 cut off")
    assert TrialStore(tmp_path).load(one) is None


def test_an_interrupted_study_goes_on_and_reports(tmp_path, monkeypatch, capsys):
    walked = []

    def interrupted(planned, *_):
        for trial in planned:
            if len(walked) == 5:
                raise KeyboardInterrupt
            walked.append(trial.name)
            yield made_up_trial(trial)

    arguments = ["--quick", "--out", str(tmp_path), "--json"]
    monkeypatch.setattr(study_fit, "walk_all", interrupted)
    with pytest.raises(KeyboardInterrupt):
        study_fit.main(arguments)
    rest = []
    monkeypatch.setattr(
        study_fit, "walk_all", lambda planned, *_: (rest.append(t) or made_up_trial(t) for t in planned)
    )
    capsys.readouterr()
    assert study_fit.main(arguments) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["trials"] == len(walked) + len(rest) > 120
    assert len({trial.name for trial in rest}) == len(rest)
    assert not {trial.name for trial in rest} & set(walked)
    assert [one["name"] for one in report["polynomials"]] == ["virtual_stiffness", "stride_frequency", "stride_height"]
    assert (tmp_path / "report.html").read_text().count("data:image/png;base64,") == 2
    assert "broken" in (tmp_path / "report.md").read_text()
    assert "adaptation" in tomllib.loads((tmp_path / "adaptation.toml").read_text())


@pytest.mark.parametrize("arguments", [["--jobs", "0"], ["--seeds", "0"], ["--grounds", "lava"]])
def test_impossible_orders_are_refused(arguments, tmp_path):
    with pytest.raises(InputError, match=r"known are|whole numbers"):
        study_fit.main([*arguments, "--out", str(tmp_path)])
