"""Tracks that somebody else has followed run through the same back end; bad tables are answered in a sentence."""

from pathlib import Path

import numpy as np
import pytest

from robot_agent.evaluation.track_recording import COLUMNS, open_tracks
from robot_agent.odometry import RecordedTracks
from weaver_shared.errors import InputError
from weaver_shared.messages import StereoFrame
from weaver_shared.transforms import Pose

DATA = Path(__file__).parents[2].parent / "shared/data/odometry/v101_tracks_30s.csv"
EMPTY = np.zeros((0, 0), dtype=np.uint8)


def _frame(stamp_ns: int) -> StereoFrame:
    return StereoFrame(stamp_ns=stamp_ns, sequence=0, left=EMPTY, right=EMPTY)


@pytest.mark.skipif(not DATA.is_file(), reason="the recording of tracks is not there")
def test_a_recording_has_its_frames_inertia_and_camera() -> None:
    recording = open_tracks(DATA)
    assert len(recording) == 601
    assert len(recording.inertia.stamp_ns) == 6001
    assert recording.calibration.left.fx == pytest.approx(458.654)
    taken = sum(len(part.stamp_ns) for _, part in recording)
    assert taken == 6001


def test_a_track_that_was_given_up_never_comes_back() -> None:
    identity = np.arange(12, dtype=np.int64)
    plane = np.random.default_rng(1).uniform(-0.4, 0.4, (12, 2))
    tracks = RecordedTracks({0: (identity, plane), 1: (identity, plane)}, 450.0)
    assert tracks.step(_frame(0), Pose.identity()).number == 12
    tracks.forget(np.array([3, 5], dtype=np.int64))
    seen = tracks.step(_frame(1), Pose.identity())
    assert set(seen.identity.tolist()) == set(range(12)) - {3, 5}
    assert seen.flow == 0.0
    assert tracks.step(_frame(2), Pose.identity()).problem == "no tracks at this instant"


def test_a_track_off_the_others_direction_of_travel_is_given_up() -> None:
    identity = np.arange(20, dtype=np.int64)
    plane = np.random.default_rng(2).uniform(-0.4, 0.4, (20, 2))
    moved = plane + np.array([0.02, 0.0])
    moved[7, 1] += 0.05
    tracks = RecordedTracks({0: (identity, plane), 1: (identity, moved)}, 450.0)
    tracks.step(_frame(0), Pose.identity())
    assert 7 not in tracks.step(_frame(1), Pose.identity()).identity


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a,b\n1,2\n", "has no column row_type"),
        (",".join(COLUMNS) + "\n", "lack the camera's camera_fx"),
    ],
)
def test_bad_tables_are_answered_in_a_sentence(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "tracks.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        open_tracks(path)
    with pytest.raises(InputError, match="can not be read"):
        open_tracks(tmp_path / "missing.csv")
