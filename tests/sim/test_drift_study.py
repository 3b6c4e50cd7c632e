"""The drift study walks its pattern and refuses what it can not walk."""

import numpy as np
import pytest

from sim_agent.command_line.study_drift import main
from sim_agent.drift_study import PATTERNS, pattern_of, walk_pattern
from weaver_shared.errors import InputError


@pytest.mark.parametrize("world", sorted(PATTERNS))
def test_a_pattern_has_five_waypoints_and_shrinks_to_a_length(world: str) -> None:
    waypoints = pattern_of(world, 2.0)
    assert len(waypoints) == 5
    path = np.array([(0.0, 0.0), *((w.x, w.y) for w in waypoints)])
    assert np.linalg.norm(np.diff(path, axis=0), axis=1).sum() == pytest.approx(2.0)


def test_the_whole_pattern_on_flat_ground_is_as_long_as_the_papers() -> None:
    path = np.array([(0.0, 0.0), *((w.x, w.y) for w in pattern_of("flat", None))])
    assert np.linalg.norm(np.diff(path, axis=0), axis=1).sum() > 20.0


@pytest.mark.walk
def test_a_short_walk_is_judged_against_the_truth() -> None:
    run = walk_pattern("flat", seed=2, metres=0.8)
    for errors in (run.with_contacts, run.without_contacts):
        assert errors.good_percent > 95.0
        assert 0.0 < errors.final_error < 0.01
        assert 0.0 < errors.normalised_error < 40.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--worlds", "moon"], "no pattern for world moon"),
        (["--runs", "0"], "whole numbers from 1"),
        (["--metres", "nan"], "no length for the pattern"),
    ],
)
def test_bad_orders_are_answered_in_a_sentence(arguments: list[str], words: str) -> None:
    with pytest.raises(InputError, match=words):
        main(arguments)
