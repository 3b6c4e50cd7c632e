"""Before spoilt pictures mislead a foot by 3 cm, their health falls below what perception asks for."""

import numpy as np
import pytest

from sim_agent.spoiled_pictures import SPOILINGS, Views
from sim_agent.worlds import make_world
from weaver_shared.robots import load_robot

WRONG = 0.03  # m


@pytest.fixture(scope="module")
def views():
    result = Views(load_robot(), make_world("testbed", 1), [0.5, 3.4], 1)
    if result.warning:
        pytest.skip(result.warning)
    return result


@pytest.mark.parametrize("kind", SPOILINGS)
def test_heights_are_refused_before_they_are_wrong(views, kind):
    levels = SPOILINGS[kind].levels
    for level in (levels[0], levels[len(levels) // 2], levels[-1]):
        result = views.spoil(kind, level)
        assert not result.trusted or result.error < WRONG, result
    assert not result.trusted  # the worst


@pytest.mark.parametrize("kind", SPOILINGS)
def test_a_little_of_it_is_borne(views, kind):
    result = views.spoil(kind, SPOILINGS[kind].levels[0])
    assert result.trusted
    assert result.seen > 0.9
    assert result.error < 0.01


def test_a_black_eye_shows_nothing(views):
    result = views.spoil("right eye dark", 1.0)
    assert result.seen == 0.0
    assert np.isnan(result.error)
    assert result.health == 0.0
