"""Inertia and feet alone lead a recorded quadruped; bad tables are answered in a sentence."""

from pathlib import Path

import numpy as np
import pytest

from robot_agent.evaluation.contact_recording import is_contact_recording, open_contacts
from weaver_shared.errors import InputError

DATA = Path(__file__).parents[2].parent / "shared/data/odometry/legged_staircase"
IMU = "sample_index,timestamp_s,omega_x,omega_y,omega_z,acc_x,acc_y,acc_z\n"
FEET = "event_index,timestamp_s,foot_index,foot_name,is_new_contact,body_x,body_y,body_z\n"
SAMPLES = "0,0.0,0,0,0,0,0,9.8\n1,0.01,0,0,0,0,0,9.8\n"


@pytest.mark.skipif(not DATA.is_dir(), reason="the recording of a staircase is not there")
def test_a_recording_has_its_feet_and_inertia() -> None:
    recording = open_contacts(DATA)
    assert is_contact_recording(DATA)
    assert len(recording) == 269
    assert recording.contacts.foot_in_body.shape == (269, 4, 3)
    assert recording.contacts.touching.sum() == 574
    felt = sum(len(part.stamp_ns) for _, part, _ in recording)
    assert 2380 < felt <= 2399
    assert 90.0 < recording.imu.rate < 110.0


def test_feet_that_an_event_does_not_name_are_in_the_air(tmp_path: Path) -> None:
    (tmp_path / "imu.csv").write_text(IMU + SAMPLES)
    (tmp_path / "contacts.csv").write_text(
        FEET + "0,0.0,0,FL,1,0.3,0.1,-0.5\n0,0.0,1,FR,1,0.3,-0.1,-0.5\n1,0.01,1,FR,0,0.29,-0.1,-0.5\n"
    )
    contacts = open_contacts(tmp_path).contacts
    assert contacts.touching.tolist() == [[True, True], [False, True]]
    assert contacts.foot_in_body[1, 1] == pytest.approx(np.array([0.29, -0.1, -0.5]))


@pytest.mark.parametrize(
    ("imu", "feet", "words"),
    [
        ("a,b\n1,2\n", FEET, "has no column timestamp_s"),
        (IMU + SAMPLES, FEET, "0 rows"),
        (IMU + SAMPLES, FEET + "0,0.0,0,FL,1,x,0.1,-0.5\n1,0.0,0,FL,1,0,0.1,-0.5\n", "is malformed"),
        (IMU + "0,0.0,0,0,0,0,0,\n1,0.1,0,0,0,0,0,9\n", FEET, "is malformed"),
    ],
)
def test_bad_tables_are_answered_in_a_sentence(tmp_path: Path, imu: str, feet: str, words: str) -> None:
    (tmp_path / "imu.csv").write_text(imu)
    (tmp_path / "contacts.csv").write_text(feet)
    with pytest.raises(InputError, match=words):
        open_contacts(tmp_path)
