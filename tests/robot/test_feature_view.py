"""Features are told of the pictures that people are shown, each kind by itself."""

import numpy as np

from robot_agent.feature_view import FeatureView
from robot_agent.odometry import Followed
from weaver_shared import topics
from weaver_shared.messages import StereoFrame

RATE = 20.0
FOLLOWED = Followed(
    identity=np.arange(3),
    pixel=np.array([[1.4, 2.6], [30.0, 40.0], [50.0, 60.0]]),
    both=np.array([True, False, True]),
    rejected=np.array([[7.0, 8.0]]),
)


def frame(sequence: int) -> StereoFrame:
    picture = np.zeros((48, 64), dtype=np.uint8)
    return StereoFrame(stamp_ns=round(sequence * 1e9 / RATE), sequence=sequence, left=picture, right=picture)


def test_each_kind_is_told_in_whole_pixels() -> None:
    shown = FeatureView(RATE).of(frame(0), FOLLOWED)
    assert shown is not None
    assert (shown.width, shown.height) == (64, 48)
    assert shown.both_eyes.tolist() == [[1, 3], [50, 60]]
    assert shown.one_eye.tolist() == [[30, 40]]
    assert shown.rejected.tolist() == [[7, 8]]


def test_they_come_with_the_pictures_that_are_shown_and_no_others() -> None:
    view = FeatureView(RATE)
    every = round(RATE / topics.CAMERA.rate)
    assert every > 1
    told = [number for number in range(5 * every) if view.of(frame(number), FOLLOWED) is not None]
    assert told == [0, every, 2 * every, 3 * every, 4 * every]


def test_a_shown_picture_that_was_missed_is_made_good_with_a_later_one() -> None:
    view = FeatureView(RATE)
    every = round(RATE / topics.CAMERA.rate)
    assert view.of(frame(0), FOLLOWED) is not None
    odd = [number for number in range(1, 3 * every) if number % every]  # the vision dropped each picture that is shown
    told = [number for number in odd if view.of(frame(number), FOLLOWED) is not None]
    assert told
    assert told[0] <= 2 * every
