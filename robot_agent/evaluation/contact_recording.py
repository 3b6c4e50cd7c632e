"""Recordings of inertia and foot contacts without pictures: `imu.csv` and `contacts.csv` in a folder."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from robot_agent.evaluation.asl_recording import inertia_up_to, interval_means
from robot_agent.evaluation.trajectory import nanoseconds
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.errors import InputError
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.messages import ImuBatch, StereoFrame
from weaver_shared.robots import load_robot
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose

IMU_COLUMNS = ("timestamp_s", "omega_x", "omega_y", "omega_z", "acc_x", "acc_y", "acc_z")
CONTACT_COLUMNS = ("event_index", "timestamp_s", "foot_index", "is_new_contact", "body_x", "body_y", "body_z")
NO_PICTURE = np.zeros((0, 0), dtype=np.uint8)


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactRecording:
    calibration: StereoCalibration  # of eyes that never see anything
    imu: Imu
    body_from_imu: Pose
    inertia: ImuBatch
    contacts: FootContacts

    def __len__(self) -> int:
        return len(self.contacts.stamp_ns)

    def __iter__(self) -> Iterator[tuple[StereoFrame, ImuBatch, FootContacts]]:
        """An empty pair at each instant of the feet, with the inertia up to it."""
        contacts = self.contacts
        parts = inertia_up_to(self.inertia, contacts.stamp_ns.tolist())
        for n, (stamp, part) in enumerate(zip(contacts.stamp_ns.tolist(), parts, strict=True)):
            felt = FootContacts(
                stamp_ns=contacts.stamp_ns[n : n + 1],
                foot_in_body=contacts.foot_in_body[n : n + 1],
                sole_in_body=contacts.sole_in_body[n : n + 1],
                touching=contacts.touching[n : n + 1],
            )
            yield StereoFrame(stamp_ns=stamp, sequence=n, left=NO_PICTURE, right=NO_PICTURE), part, felt


def is_contact_recording(folder: Path) -> bool:
    return (folder / "imu.csv").is_file() and (folder / "contacts.csv").is_file()


def open_contacts(folder: Path) -> ContactRecording:
    """Raises InputError that names what is missing or malformed."""
    samples = _table(folder / "imu.csv", IMU_COLUMNS)
    try:
        inertia = ImuBatch(
            stamp_ns=np.array([nanoseconds(row["timestamp_s"]) for row in samples], dtype=np.int64),
            angular_velocity_in_imu=_numbers(samples, IMU_COLUMNS[1:4]),
            specific_force_in_imu=_numbers(samples, IMU_COLUMNS[4:7]),
        )
    except (ValueError, TypeError) as error:
        raise InputError(f"{folder / 'imu.csv'} is malformed: {error}") from error
    contacts = read_contacts(folder / "contacts.csv")
    rate = 1e9 * (len(inertia.stamp_ns) - 1) / float(inertia.stamp_ns[-1] - inertia.stamp_ns[0])
    return ContactRecording(
        calibration=StereoCalibration.of_robot(load_robot()),
        imu=_imu(rate),
        body_from_imu=Pose.identity(),
        inertia=interval_means(inertia),
        contacts=contacts,
    )


def read_contacts(path: Path) -> FootContacts:
    """Raises InputError that names what is missing or malformed."""
    try:
        return _contacts(_table(path, CONTACT_COLUMNS))
    except (ValueError, TypeError) as error:
        raise InputError(f"{path} is malformed: {error}") from error


def _imu(rate: float) -> Imu:
    """A tactical MEMS unit on a trotting quadruped: what touches down shakes it far beyond its data sheet."""
    return Imu(
        position_in_body=(0.0, 0.0, 0.0),
        rate=rate,
        gyro_noise_density=1e-3,
        gyro_random_walk=2e-5,
        accel_noise_density=2e-2,
        accel_random_walk=1e-3,
    )


def _contacts(rows: list[dict[str, str]]) -> FootContacts:
    """One instant an event; a foot that is not named in it is in the air, and one newly set down begins anew."""
    legs = 1 + max(int(row["foot_index"]) for row in rows)
    events: dict[int, list[dict[str, str]]] = {}
    for row in rows:
        events.setdefault(int(row["event_index"]), []).append(row)
    stamps = np.zeros(len(events), dtype=np.int64)
    feet = np.zeros((len(events), legs, 3))
    touching: NDArray[np.bool_] = np.zeros((len(events), legs), dtype=np.bool_)
    for n, (_, named) in enumerate(sorted(events.items())):
        stamps[n] = nanoseconds(named[0]["timestamp_s"])
        for row in named:
            foot = int(row["foot_index"])
            feet[n, foot] = [float(row[key]) for key in CONTACT_COLUMNS[4:]]
            touching[n, foot] = True
    return FootContacts(stamp_ns=stamps, foot_in_body=feet, sole_in_body=feet, touching=touching)


def _numbers(rows: list[dict[str, str]], keys: tuple[str, ...]) -> NDArray[np.float64]:
    return np.array([[float(row[key]) for key in keys] for row in rows])


def _table(path: Path, columns: tuple[str, ...]) -> list[dict[str, str]]:
    try:
        with path.open(newline="") as file:
            table = csv.DictReader(file)
            missing = [name for name in columns if name not in (table.fieldnames or ())]
            if missing:
                raise InputError(f"{path} has no column {', '.join(missing)}")
            rows = list(table)
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path} can not be read: {error}") from error
    if len(rows) < 2:
        raise InputError(f"{path} has {len(rows)} rows; at least 2 are needed")
    return rows
