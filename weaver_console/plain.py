"""Messages as JSON for the page: dataclass fields by name, arrays as lists, not-a-number as null."""

import base64
import dataclasses
from typing import Any

import msgspec
import numpy as np

from weaver_shared.messages import CameraPicture, MapTile

DECIMALS = 5
"""Digits kept behind the point: 10 micrometres or microradians, half the bytes of full doubles."""

FINE = frozenset({"covariance", "gyro_bias", "accel_bias"})
FINE_DECIMALS = 10
"""For fields whose squares or drifts are far smaller than that."""

_encoder = msgspec.json.Encoder()  # NaN and infinities become null


def to_json(value: Any) -> bytes:
    return _encoder.encode(value)


def plain(message: Any) -> Any:
    """`message` as dicts, lists, numbers, strings, booleans and None."""
    if isinstance(message, MapTile | CameraPicture):
        return {name: _packed(getattr(message, name)) for name in _names(message)}
    return _plain(message)


def _plain(value: Any, decimals: int = DECIMALS) -> Any:
    if isinstance(value, float):
        return round(value, decimals)
    if isinstance(value, np.ndarray):
        rounded = np.round(value, decimals) if value.dtype.kind == "f" else value
        return rounded.tolist()
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    if dataclasses.is_dataclass(value):
        return {
            name: _plain(getattr(value, name), FINE_DECIMALS if name in FINE else DECIMALS) for name in _names(value)
        }
    return value


def _packed(value: Any) -> Any:
    """Bulk data as base64 of the raw little-endian bytes."""
    if isinstance(value, np.ndarray):
        value = np.ascontiguousarray(value, dtype=value.dtype.newbyteorder("<")).tobytes()
    if isinstance(value, bytes):
        return base64.b64encode(value).decode("ascii")
    return value


def _names(message: Any) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(message))
