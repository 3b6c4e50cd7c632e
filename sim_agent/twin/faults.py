"""What can go wrong with an emulated robot, by name: the list that a real one's program has to stand up to."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from sim_agent.sensor_lines import TwinSensors
from sim_agent.servo_bus.bus import EmulatedBus
from sim_agent.servo_bus.servo import EmulatedServo
from weaver_shared.errors import InputError

HOT = 85.0  # degrees Celsius
FACTORY_LATENCY = 16e-3  # s
OVERLOADED = 32


@dataclass(frozen=True, slots=True, kw_only=True)
class Devices:
    """What faults happen to. `plug` puts a bus's adapter in (True) or pulls it out."""

    joints: Sequence[str]
    servos: Sequence[EmulatedServo]
    buses: dict[str, EmulatedBus]
    sensors: TwinSensors
    now_ns: Callable[[], int]
    plug: Callable[[str, bool], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """One thing that goes wrong. `target` is what it happens to: "joint", "bus" or nothing."""

    name: str
    what: str
    target: str
    usual: float  # value when none is given
    happen: Callable[[Devices, str, float], None]
    end: Callable[[Devices, str], None] | None = None  # None: it does not end by itself


def inject(devices: Devices, name: str, target: str = "", value: float | None = None, *, ending: bool = False) -> str:
    """Let a fault happen, or end; returns a sentence. Raises InputError that names what is valid."""
    fault = FAULTS.get(name)
    if fault is None:
        raise InputError(f"fault {name!r} is unknown; known are {', '.join(FAULTS)}")
    valid = {"joint": list(devices.joints), "bus": list(devices.buses), "": [""]}[fault.target]
    if target not in valid:
        wanted = f"one {fault.target} of {', '.join(valid)}" if fault.target else "nothing to happen to"
        raise InputError(f"fault {name} needs {wanted}, not {target!r}")
    if ending and fault.end is None:
        raise InputError(f"fault {name} does not end by itself")
    if ending and fault.end is not None:
        fault.end(devices, target)
        return f"{fault.what} no longer"
    fault.happen(devices, target, fault.usual if value is None else value)
    return fault.what


def _servo(devices: Devices, joint: str) -> EmulatedServo:
    return devices.servos[list(devices.joints).index(joint)]


def _on_wire(what: str, usual: float, name: str, trouble: str) -> Fault:
    def happen(devices: Devices, bus: str, value: float) -> None:
        setattr(devices.buses[bus].troubles, trouble, value)

    return Fault(
        name=name,
        what=what,
        target="bus",
        usual=usual,
        happen=happen,
        end=lambda devices, bus: happen(devices, bus, 0.0),
    )


def _in_servo(
    what: str,
    name: str,
    happen: Callable[[EmulatedServo, float, int], None],
    end: Callable[[EmulatedServo], None] | None = None,
    usual: float = 0.0,
) -> Fault:
    def begin(devices: Devices, joint: str, value: float) -> None:
        happen(_servo(devices, joint), value, devices.now_ns())

    def finish(devices: Devices, joint: str) -> None:
        if end is not None:
            end(_servo(devices, joint))

    return Fault(name=name, what=what, target="joint", usual=usual, happen=begin, end=finish if end else None)


def _spoil(devices: Devices, joint: str, value: float) -> None:
    servo = _servo(devices, joint)
    bus = next(bus for bus in devices.buses.values() if servo in bus.servos)
    bus.troubles.spoilt_answers, bus.troubles.spoilt_ids = value, frozenset({servo.id})


def _brown_out(devices: Devices, _target: str, _value: float) -> None:
    for servo in devices.servos:
        servo.restart(devices.now_ns())


def _slow_wire(devices: Devices, bus: str, value: float) -> None:
    devices.buses[bus].latency_ns = round(value * 1e9)


def _of_sensors(what: str, name: str, trouble: str, usual: float, ended: float) -> Fault:
    def happen(devices: Devices, _target: str, value: float) -> None:
        setattr(devices.sensors.troubles, trouble, value)

    return Fault(
        name=name, what=what, target="", usual=usual, happen=happen, end=lambda devices, _: happen(devices, "", ended)
    )


_LIST = (
    _on_wire("servos' answers are lost", 0.02, "lost-answers", "lost_answers"),
    _on_wire("questions to servos are lost", 0.02, "lost-questions", "lost_questions"),
    Fault(
        name="spoilt-answers",
        what="a servo's answers come damaged",
        target="joint",
        usual=0.05,
        happen=_spoil,
        end=lambda devices, joint: _spoil(devices, joint, 0.0),
    ),
    Fault(
        name="slow-adapter",
        what="an adapter keeps bytes for its latency timer",
        target="bus",
        usual=FACTORY_LATENCY,
        happen=_slow_wire,
        end=lambda devices, bus: _slow_wire(devices, bus, 1e-3),
    ),
    Fault(
        name="unplugged",
        what="a bus's adapter is pulled out",
        target="bus",
        usual=0.0,
        happen=lambda devices, bus, _: devices.plug(bus, False),
        end=lambda devices, bus: devices.plug(bus, True),
    ),
    _in_servo(
        "a servo is dead",
        "dead",
        lambda servo, _value, _now: setattr(servo, "alive", False),
        lambda servo: setattr(servo, "alive", True),
    ),
    _in_servo("a servo shuts down for overload", "overload", lambda servo, _value, _now: servo.fail(OVERLOADED)),
    _in_servo(
        "a servo is hot",
        "hot",
        lambda servo, value, _now: setattr(servo, "temperature", value),
        lambda servo: setattr(servo, "temperature", 25.0),
        HOT,
    ),
    _in_servo("a servo loses power for a moment", "reset", lambda servo, _value, now: servo.restart(now)),
    _in_servo(
        "a servo's encoder is wrong by so many counts",
        "encoder",
        lambda servo, value, _now: setattr(servo, "slipped", round(value)),
        lambda servo: setattr(servo, "slipped", 0),
        600.0,
    ),
    _in_servo(
        "a joint is jammed",
        "jammed",
        lambda servo, _value, _now: servo.jam(),
        lambda servo: setattr(servo, "jammed_at", None),
    ),
    Fault(name="brown-out", what="all servos lose power for a moment", target="", usual=0.0, happen=_brown_out),
    _of_sensors("the IMU is silent", "imu-silent", "imu_silent", 1.0, 0.0),
    _of_sensors("the IMU repeats itself", "imu-frozen", "imu_frozen", 1.0, 0.0),
    _of_sensors("the IMU's clock jumps by so many s", "imu-clock", "imu_clock", 100.0, 0.0),
    _of_sensors("the power monitor is silent", "power-silent", "power_silent", 1.0, 0.0),
    _of_sensors("the battery is at so many V", "battery", "battery", 22.0, 0.0),
)
FAULTS = {fault.name: fault for fault in _LIST}
