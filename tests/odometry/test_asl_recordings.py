"""EuRoC folders: the real ones are followed standing still, the broken ones refused in one sentence."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from robot_agent.command_line.odometry import main
from robot_agent.evaluation.asl_recording import interval_means, open_asl
from robot_agent.evaluation.trajectory import read_tum
from weaver_shared.errors import InputError
from weaver_shared.messages import ImuBatch

MICRO = Path(__file__).resolve().parents[2] / ".." / "shared" / "data" / "odometry" / "euroc_v101_micro"
needs_recording = pytest.mark.skipif(not MICRO.is_dir(), reason=f"no recording at {MICRO}")


@needs_recording
def test_a_real_vehicle_at_rest_stays_within_three_millimetres(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "trajectory.txt"
    assert main([str(MICRO), "--json", "--quiet", "--output", str(out)]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["frames"] == 60
    assert report["final_error"] < 0.003
    assert report["ate_m"] < 0.003
    assert report["drift_percent"] is None
    assert report["gravity_error_deg"] < 1.0
    assert report["gyro_bias"] == pytest.approx([-0.0022, 0.0208, 0.0777], abs=0.003)  # of the recording's own truth
    assert len(read_tum(out)) == 60


@needs_recording
def test_an_eye_with_missing_pictures_is_tolerated(tmp_path: Path) -> None:
    folder = tmp_path / "recording"
    shutil.copytree(MICRO, folder)
    for path in sorted((folder / "mav0" / "cam1" / "data").glob("*.png"))[10:40]:
        path.unlink()
    (folder / "mav0" / "cam1" / "data.csv").unlink()
    recording = open_asl(folder)
    assert len(recording) == 60
    assert sum(right is None for _, _, right in recording.pictures) == 30
    frame = next(frame for frame, _ in recording if frame.sequence == 20)
    assert frame.right.size == 0
    assert frame.left.shape == (480, 752)


@needs_recording
def test_inertia_comes_with_the_picture_it_leads_to() -> None:
    recording = open_asl(MICRO)
    seen = -1
    for frame, batch in recording:
        assert batch.stamp_ns[-1] >= frame.stamp_ns
        assert batch.stamp_ns[0] > seen
        seen = int(batch.stamp_ns[-1])


def test_instants_become_means_over_the_intervals_before_them() -> None:
    ramp = np.arange(5.0)[:, None] * [1.0, 2.0, 3.0]
    batch = ImuBatch(stamp_ns=np.arange(5, dtype=np.int64), angular_velocity_in_imu=ramp, specific_force_in_imu=-ramp)
    assert interval_means(batch).angular_velocity_in_imu[3] == pytest.approx([2.5, 5.0, 7.5])


def _spoil_yaml(folder: Path) -> None:
    path = folder / "mav0" / "cam0" / "sensor.yaml"
    path.write_text(path.read_text().replace("radial-tangential", "wobbly"))


def _spoil_inertia(folder: Path) -> None:
    (folder / "mav0" / "imu0" / "data.csv").write_text("#nothing\n")


def _spoil_eye(folder: Path) -> None:
    shutil.rmtree(folder / "mav0" / "cam1")


@needs_recording
@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [(_spoil_yaml, "'wobbly' is unknown; known are"), (_spoil_inertia, "no table"), (_spoil_eye, "cam1 has no sensor")],
)
def test_a_broken_recording_is_refused(tmp_path: Path, spoil: Callable[[Path], None], sentence: str) -> None:
    folder = tmp_path / "recording"
    shutil.copytree(MICRO, folder)
    spoil(folder)
    with pytest.raises(InputError, match=sentence):
        main([str(folder), "--json", "--quiet"])


def test_what_is_not_a_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is not a folder"):
        main([str(tmp_path / "nowhere"), "--json"])
