"""Messages to bytes and back: MessagePack with a schema version, arrays as raw little-endian buffers.

Only this module knows the wire format. A message is the list [version, tag, field, field, ...]; an array is the
list [dtype, shape, bytes]. Fields are only ever added at the end and with a default, which stands for them in older
messages.
"""

from __future__ import annotations

import dataclasses
import typing
from typing import Any, TypeVar

import msgspec
import numpy as np

from weaver_shared import messages
from weaver_shared.errors import MessageError

SCHEMA_VERSION = 1

M = TypeVar("M")

_DTYPES = {"|b1", "|u1", "<i2", "<i8", "<f4", "<f8"}
_encoder = msgspec.msgpack.Encoder()
_layouts: dict[type[Any], dict[str, Any]] = {}
_fewest: dict[type[Any], int] = {}
"""Fields that a message must have: those without a default."""


def encode(message: Any) -> bytes:
    """Bytes of any dataclass in `weaver_shared.messages`."""
    kind = type(message)
    fields = [getattr(message, name) for name in _layout(kind)]
    return _encoder.encode([SCHEMA_VERSION, kind.__name__, *map(_plain_field, fields)])


def decode(data: bytes | bytearray | memoryview, kind: type[M]) -> M:
    """The message in `data`. Raises MessageError when it is damaged, of another kind or another schema."""
    try:
        parts = msgspec.msgpack.decode(data)
    except (msgspec.MsgspecError, ValueError, TypeError, OverflowError, RecursionError) as error:
        raise MessageError(f"{kind.__name__}: not a MessagePack message ({error})") from error
    if not isinstance(parts, list) or len(parts) < 2:
        raise MessageError(f"{kind.__name__}: expected a list of version, kind and fields")
    version, tag, *values = parts
    if version != SCHEMA_VERSION:
        raise MessageError(
            f"{kind.__name__}: schema {version!r:.20} is not ours, which is {SCHEMA_VERSION}; update both ends"
        )
    if tag != kind.__name__:
        raise MessageError(f"expected {kind.__name__}, got {tag!r:.40}")
    return _build(kind, values)


def _build(kind: type[M], values: list[Any]) -> M:
    layout = _layout(kind)
    if not _fewest[kind] <= len(values) <= len(layout):
        raise MessageError(f"{kind.__name__}: {len(values)} fields, expected {len(layout)}")
    try:
        return kind(**{name: _restore(layout[name], value) for name, value in zip(layout, values, strict=False)})
    except MessageError:
        raise
    except (msgspec.ValidationError, TypeError, ValueError, OverflowError) as error:
        raise MessageError(f"{kind.__name__}: {error}") from error


def _layout(kind: type[Any]) -> dict[str, Any]:
    """Field names with their types, in wire order."""
    layout = _layouts.get(kind)
    if layout is None:
        hints = typing.get_type_hints(kind)
        fields = dataclasses.fields(kind)
        layout = _layouts[kind] = {field.name: hints[field.name] for field in fields}
        _fewest[kind] = sum(field.default is dataclasses.MISSING for field in fields)
    return layout


def _plain_field(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic) or dataclasses.is_dataclass(value):
        return _plain(value)
    if isinstance(value, tuple):
        return [_plain_field(item) for item in value]
    return value


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        little = np.ascontiguousarray(value, dtype=value.dtype.newbyteorder("<"))
        return [little.dtype.str, list(little.shape), little.reshape(-1).data.cast("B") if little.size else b""]
    if isinstance(value, np.generic):
        return value.item()
    if dataclasses.is_dataclass(value):
        return [_plain_field(getattr(value, name)) for name in _layout(type(value))]
    raise TypeError(f"{type(value).__name__} does not travel in messages")


def _restore(hint: Any, value: Any) -> Any:
    origin = typing.get_origin(hint)
    if origin is np.ndarray:
        return _restore_array(hint, value)
    if isinstance(hint, type) and dataclasses.is_dataclass(hint):
        if not isinstance(value, list):
            raise MessageError(f"{hint.__name__}: expected a list of fields")
        return _build(hint, value)
    if origin is tuple:
        item = typing.get_args(hint)[0]
        if not isinstance(value, list):
            raise MessageError("expected a list")
        return tuple(_restore(item, part) for part in value)
    return msgspec.convert(value, hint)


def _restore_array(hint: Any, value: Any) -> Any:
    if not (isinstance(value, list) and len(value) == 3 and isinstance(value[1], list)):
        raise MessageError("an array is a list of dtype, shape and bytes")
    dtype, shape, buffer = value
    wanted = np.dtype(typing.get_args(typing.get_args(hint)[1])[0])
    if dtype not in _DTYPES or np.dtype(dtype) != wanted:
        raise MessageError(f"an array of {dtype!r:.20} where {wanted} belongs")
    if not all(isinstance(n, int) and n >= 0 for n in shape) or not isinstance(buffer, bytes):
        raise MessageError("an array with a damaged shape")
    count = 1
    for n in shape:
        count *= n
    if count * wanted.itemsize != len(buffer):
        raise MessageError(f"an array of shape {shape} does not hold {len(buffer)} bytes")
    return np.frombuffer(buffer, dtype=wanted).reshape(shape)


MESSAGES: dict[str, type] = {
    name: getattr(messages, name) for name in messages.__all__ if dataclasses.is_dataclass(getattr(messages, name))
}
"""Every message by its tag, for recorders and tools that read any of them."""
