"""Guided: views that add something are kept, what is missing is said, and the result is Kalibr's files."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from calibrator_desk import Desk
from own_recordings import small_eyed

from robot_agent.calibration.drawing import drawn
from robot_agent.calibration.guided import GuidedCalibration
from robot_agent.calibration.kalibr_files import read_target
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.target_words import target_of
from robot_agent.recording import open_recording
from robot_agent.vision.camchain import read_chain
from robot_agent.vision.camera import StereoCalibration
from sim_agent.targets.recording import RigTruth
from weaver_shared import topics
from weaver_shared.errors import InputError
from weaver_shared.messages import (
    CommandName,
    PartRequest,
    StereoFrame,
)

TARGET = "aprilgrid 4 4 0.08 0.3"
START, SOLVE, END = CommandName.START_CALIBRATION, CommandName.SOLVE_CALIBRATION, CommandName.END_CALIBRATION


@pytest.fixture
def frames(own_recording: Path) -> list[StereoFrame]:
    return [frame for _, _, frame in open_recording(own_recording).messages(topics.STEREO)]


@pytest.fixture
def guided() -> GuidedCalibration:
    pair = StereoCalibration.of_robot(small_eyed())
    return GuidedCalibration(target_of(TARGET), Rig.of((pair.left, pair.right)))


def test_a_view_is_kept_once_and_its_fields_count_as_covered(
    guided: GuidedCalibration, frames: list[StereoFrame]
) -> None:
    assert "bring the target" not in guided.advice()
    assert guided.look(frames[0])
    assert not guided.look(frames[0])
    assert (guided.views, guided.pictures) == (1, 2)
    corners = sum(len(sighting) for sighting in guided.sightings if sighting is not None)
    assert guided.cover().shape == (2, 6, 8)
    assert guided.cover().sum() == corners > 32
    assert guided.advice().startswith("take 19 more pictures")


def test_without_a_target_it_is_asked_for(guided: GuidedCalibration) -> None:
    grey = np.full((240, 320), 90, dtype=np.uint8)
    assert not guided.look(StereoFrame(stamp_ns=1, sequence=1, left=grey, right=grey))
    assert guided.advice().startswith("bring the target into the picture: looking for an AprilGrid of 4 x 4 tags")


def test_found_corners_are_drawn_where_they_are(guided: GuidedCalibration, frames: list[StereoFrame]) -> None:
    guided.look(frames[0])
    picture = cv2.imdecode(np.frombuffer(drawn(frames[0], guided.sightings), np.uint8), cv2.IMREAD_COLOR).astype(int)
    green = picture[:, :, 1] - np.maximum(picture[:, :, 0], picture[:, :, 2])
    assert picture.shape == (240, 640, 3)
    left = guided.sightings[0]
    assert left is not None
    for x, y in np.rint(left.pixels).astype(int):
        near = green[max(y - 5, 0) : y + 6, max(x - 5, 0) : x + 6]
        assert near.max() > 40


def test_pictures_of_another_size_than_described_are_refused(guided: GuidedCalibration) -> None:
    large = np.zeros((480, 640), dtype=np.uint8)
    with pytest.raises(InputError, match="640 x 480 px, the robot's description says 320 x 240"):
        guided.look(StereoFrame(stamp_ns=1, sequence=1, left=large, right=large))


@pytest.mark.parametrize(
    "text", ["", "aprilgrid", "aprilgrid 6 6 0.088", "circles 3 4 5 6", "checkerboard a b c", "aprilgrid nan 6 1 1"]
)
def test_a_target_that_is_none_is_answered_with_how_to_write_one(text: str) -> None:
    with pytest.raises(InputError, match="is no target; write aprilgrid COLUMNS"):
        target_of(text)


def test_a_recording_leads_to_kalibrs_files_and_a_report(desk: Desk, truth: RigTruth, tmp_path: Path) -> None:
    assert desk.told[-1].phase == "idle"
    assert desk.order(START, f"{TARGET} from own.mcap").accepted
    desk.await_end_of_recording()
    assert len(desk.pictures) >= 20
    looking = desk.told[-1]
    assert looking.phase == "looking"
    assert looking.source == "own.mcap"
    assert looking.views > 10
    assert max(looking.seen) > 16
    assert desk.pictures[-1].name == "calibration"
    assert desk.order(SOLVE, "radtan").accepted
    solved = desk.await_solution()
    assert solved.phase == "solved", solved.verdict
    folder = tmp_path / "sim-1_2026-01-02_03-04-05"
    assert {path.name for path in folder.iterdir()} == {file.rpartition("/")[2] for file in solved.files}
    found = Rig.of(read_chain(folder / "camchain.yaml").cameras)
    assert np.abs(found.intrinsics[:, :2] / truth.rig.intrinsics[:, :2] - 1.0).max() < 0.02
    assert found.baseline == pytest.approx(truth.rig.baseline, abs=1e-3)
    assert read_target(folder / "target.yaml") == target_of(TARGET)
    report = next(file for file in solved.files if file.endswith("report.html"))
    part = desk.bus.ask("sim-1", topics.CALIBRATION_PART, PartRequest(name=report, offset=0, length=1 << 20))
    assert part.data.count(b"<svg") == 5
    assert any("baseline" in line for line in solved.results)
    assert solved.calibrations == ("sim-1_2026-01-02_03-04-05",)


def test_what_can_not_be_done_is_refused_with_the_reason(desk: Desk) -> None:
    assert desk.order(SOLVE).reason == "there is nothing to solve"
    assert "is no target" in desk.order(START, "a plate").reason
    assert "is not the name of a recording" in desk.order(START, f"{TARGET} from ../../etc/passwd").reason
    assert "can not be read" in desk.order(START, f"{TARGET} from none.mcap").reason
    assert desk.order(START, TARGET).accepted
    desk.await_start()
    assert "lens model 'plastic' is unknown" in desk.order(SOLVE, "plastic").reason
    assert desk.order(SOLVE).accepted
    assert desk.await_solution().phase == "failed"
    assert "the left eye sees the target in 0 of 0 pictures" in desk.told[-1].verdict
    assert desk.order(END).accepted
    assert desk.told[-1].phase == "idle"
