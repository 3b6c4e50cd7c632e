"""What an emulated camera can be set to, where the registers of that are, and the GenICam file that tells clients so.

Names, lines and their meaning are those of a Grasshopper3 as far as `robot_agent` sets one up.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

MONO8 = 0x01080001
LINES = {f"Line{number}": number for number in range(4)}
SWITCH = {"Off": 0, "On": 1}


@dataclass(frozen=True, slots=True, kw_only=True)
class Feature:
    """One setting. `entries`: the names of its values; `per_line`: one register for each line, by LineSelector."""

    name: str
    address: int
    kind: str  # Enumeration, Integer, Float, Boolean or Command
    entries: dict[str, int] = field(default_factory=dict)
    default: float = 0
    per_line: bool = False
    writable: bool = True


def _choice(name: str, address: int, entries: dict[str, int], default: str, *, per_line: bool = False) -> Feature:
    return Feature(
        name=name, address=address, kind="Enumeration", entries=entries, default=entries[default], per_line=per_line
    )


AUTOMATIC = {"Off": 0, "Once": 1, "Continuous": 2}
FEATURES = {
    feature.name: feature
    for feature in (
        Feature(name="Width", address=0x1000, kind="Integer", writable=False),
        Feature(name="Height", address=0x1004, kind="Integer", writable=False),
        Feature(name="OffsetX", address=0x1008, kind="Integer", writable=False),
        Feature(name="OffsetY", address=0x100C, kind="Integer", writable=False),
        Feature(name="PayloadSize", address=0x1010, kind="Integer", writable=False),
        _choice("PixelFormat", 0x1014, {"Mono8": MONO8}, "Mono8"),
        _choice("AcquisitionMode", 0x1018, {"Continuous": 0}, "Continuous"),
        Feature(name="AcquisitionStart", address=0x101C, kind="Command"),
        Feature(name="AcquisitionStop", address=0x1020, kind="Command"),
        _choice("ExposureAuto", 0x1024, AUTOMATIC, "Continuous"),
        _choice("GainAuto", 0x1028, AUTOMATIC, "Continuous"),
        Feature(name="ExposureTime", address=0x102C, kind="Float", default=10_000.0),  # microseconds
        Feature(name="Gain", address=0x1030, kind="Float"),  # dB
        Feature(name="ChunkModeActive", address=0x1034, kind="Boolean"),
        _choice("TriggerMode", 0x1038, SWITCH, "Off"),
        _choice("TriggerSelector", 0x103C, {"FrameStart": 0}, "FrameStart"),
        _choice("TriggerSource", 0x1040, LINES | {"Software": 16}, "Line0"),
        _choice("TriggerActivation", 0x1044, {"FallingEdge": 0, "RisingEdge": 1}, "FallingEdge"),
        _choice("TriggerOverlap", 0x1048, {"Off": 0, "ReadOut": 1}, "Off"),
        _choice("AcquisitionFrameRateAuto", 0x104C, AUTOMATIC, "Continuous"),
        Feature(name="AcquisitionFrameRateEnabled", address=0x1050, kind="Boolean"),
        Feature(name="AcquisitionFrameRate", address=0x1054, kind="Float", default=20.0),
        _choice("LineSelector", 0x1058, LINES, "Line0"),
        _choice("LineMode", 0x1060, {"Input": 0, "Output": 1}, "Input", per_line=True),
        _choice("LineSource", 0x1070, {"Off": 0, "ExposureActive": 1}, "Off", per_line=True),
    )
}
LATCH_CONTROL, LATCHED = 0x0944, 0x0948
"""Standard registers: writing 2 to the first keeps the camera's time in the second."""
CHUNKS = {"ChunkFrameCounter": 0x21, "ChunkTimestamp": 0x22, "ChunkExposureTime": 0x23, "ChunkGain": 0x24}
_CHUNK_KINDS = {
    "ChunkFrameCounter": ("Integer", 4),
    "ChunkTimestamp": ("Integer", 8),
    "ChunkExposureTime": ("Float", 8),
    "ChunkGain": ("Float", 8),
}


def description() -> bytes:
    """The GenICam file."""
    nodes = [_category(), '<Port Name="Device" NameSpace="Standard"/>']
    for feature in FEATURES.values():
        nodes += _nodes(feature)
    nodes += _latch()
    for name, (kind, length) in _CHUNK_KINDS.items():
        port = f"{name}Port"
        nodes.append(f'<Port Name="{port}"><ChunkID>{CHUNKS[name]:x}</ChunkID></Port>')
        nodes.append(f'<{kind} Name="{name}" NameSpace="Standard"><pValue>{name}Register</pValue></{kind}>')
        nodes.append(_register(name, 0, kind=kind, length=length, port=port, access="RO"))
    head = (
        '<RegisterDescription ModelName="Rendered" VendorName="Weaver" StandardNameSpace="None" SchemaMajorVersion="1"'
        ' SchemaMinorVersion="0" SchemaSubMinorVersion="1" MajorVersion="1" MinorVersion="0" SubMinorVersion="0"'
        ' ToolTip="Shows rendered pictures" ProductGuid="0" VersionGuid="0"'
        ' xmlns="http://www.genicam.org/GenApi/Version_1_0">'
    )
    return "\n".join(['<?xml version="1.0" encoding="utf-8"?>', head, *nodes, "</RegisterDescription>"]).encode()


def _category() -> str:
    names = [*FEATURES, "GevTimestampControlLatch", "GevTimestampValue", *CHUNKS]
    listed = "".join(f"<pFeature>{name}</pFeature>" for name in names)
    return f'<Category Name="Root" NameSpace="Standard">{listed}</Category>'


def _nodes(feature: Feature) -> Iterator[str]:
    inner = "".join(
        f'<EnumEntry Name="{name}" NameSpace="Standard"><Value>{value}</Value></EnumEntry>'
        for name, value in feature.entries.items()
    )
    value = f"<pValue>{feature.name}Register</pValue>"
    after = {"Command": "<CommandValue>1</CommandValue>", "Boolean": "<OnValue>1</OnValue><OffValue>0</OffValue>"}
    yield (
        f'<{feature.kind} Name="{feature.name}" NameSpace="Standard">{inner}{value}'
        f"{after.get(feature.kind, '')}</{feature.kind}>"
    )
    yield _register(
        feature.name,
        feature.address,
        kind=feature.kind,
        access="RW" if feature.writable else "RO",
        index='<pIndex Offset="4">LineSelectorRegister</pIndex>' if feature.per_line else "",
    )


def _latch() -> Iterator[str]:
    yield (
        '<Command Name="GevTimestampControlLatch" NameSpace="Standard"><pValue>LatchRegister</pValue>'
        "<CommandValue>2</CommandValue></Command>"
    )
    yield _register("Latch", LATCH_CONTROL, kind="Command", access="WO")
    yield (
        '<Integer Name="GevTimestampValue" NameSpace="Standard"><pValue>GevTimestampValueRegister</pValue></Integer>'
    )
    yield _register("GevTimestampValue", LATCHED, kind="Integer", length=8, access="RO")


def _register(
    name: str, address: int, *, kind: str, length: int = 4, port: str = "Device", access: str = "RW", index: str = ""
) -> str:
    tag, sign = ("FloatReg", "") if kind == "Float" else ("IntReg", "<Sign>Unsigned</Sign>")
    return (
        f'<{tag} Name="{name}Register" NameSpace="Custom"><Address>{address:#x}</Address>{index}'
        f"<Length>{length}</Length><AccessMode>{access}</AccessMode><pPort>{port}</pPort>"
        f"<Cachable>NoCache</Cachable>{sign}<Endianess>BigEndian</Endianess></{tag}>"
    )
