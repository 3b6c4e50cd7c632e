"""Who answers on a bus when everybody is asked: ids, models and firmware against the wiring."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from robot_agent.hardware.doctor.finding import Finding, Verdict, named
from robot_agent.hardware.servos.frame_reader import FrameReader
from robot_agent.hardware.servos.packet import BROADCAST, HIGHEST_ID, Instruction, encode, status_of
from robot_agent.hardware.servos.port import LineClock, PortLostError, ServoPort
from robot_agent.hardware.servos.registers import LEAST_FIRMWARE, MODELS
from robot_agent.hardware.wiring import Wiring

PER_ID_NS = 3_000_000
"""What the vendor's SDK allows each possible servo for its answer to a broadcast ping."""
ANSWER_LENGTH = 14


@dataclass(frozen=True, slots=True, kw_only=True)
class Heard:
    id: int
    model: int
    firmware: int

    @property
    def name(self) -> str:
        return MODELS[self.model].name if self.model in MODELS else f"model {self.model}"


@dataclass(slots=True)
class BusAnswers:
    """Servos by id as they answered; `damaged` are answers that could not be read."""

    servos: list[Heard]
    damaged: int = 0


def ask_everybody(ports: Mapping[str, ServoPort], clock: LineClock, margin: float) -> dict[str, BusAnswers]:
    """Broadcast a ping on all buses at once and wait for whoever may answer, by name of the bus."""
    answers = {name: BusAnswers([]) for name in ports}
    readers = {name: FrameReader() for name in ports}
    open_ports = dict(ports)
    for name, port in ports.items():
        try:
            port.send(encode(BROADCAST, Instruction.PING))
        except PortLostError:
            del open_ports[name]
    deadline_ns = clock.now_ns() + (HIGHEST_ID + 1) * PER_ID_NS + round(margin * 1e9)
    while open_ports and clock.now_ns() < deadline_ns:
        clock.wait_for_answer(list(open_ports.values()), deadline_ns)
        for name, port in list(open_ports.items()):
            try:
                frames = readers[name].feed(port.receive())
            except PortLostError:
                del open_ports[name]
                continue
            for frame in frames:
                status = status_of(frame)
                if status is not None and len(status.parameters) == 3:
                    model = int.from_bytes(status.parameters[:2], "little")
                    answers[name].servos.append(Heard(id=status.id, model=model, firmware=status.parameters[2]))
    for name, reader in readers.items():
        reader.finish()
        answers[name].damaged = reader.rejected
    return answers


def judge_bus(wiring: Wiring, bus: str, answers: BusAnswers) -> Finding:
    """The servos of one bus against what the wiring says hangs there."""
    names, heard = wiring.robot.joint_names, {servo.id: servo for servo in answers.servos}
    joints = {wiring.ids[joint]: int(joint) for joint in wiring.joints_of(bus)}
    missing = [f"{names[joint]} (id {servo})" for servo, joint in joints.items() if servo not in heard]
    foreign = [f"id {servo} ({heard[servo].name})" for servo in sorted(heard) if servo not in joints]
    twice = sorted(servo for servo, count in Counter(servo.id for servo in answers.servos).items() if count > 1)
    here = [(joint, heard[servo]) for servo, joint in joints.items() if servo in heard]
    mistaken = [
        f"{names[joint]} is {servo.name}, not {wiring.models[joint].name}"
        for joint, servo in here
        if servo.model != wiring.models[joint].number
    ]
    old = [f"{names[joint]} has {servo.firmware}" for joint, servo in here if servo.firmware < LEAST_FIRMWARE]
    troubles: list[tuple[list[str], str, str]] = [
        (
            missing,
            "no answer from",
            "check power, cable, id and baud rate of each; a new servo has id 1 and 57600 bit/s",
        ),
        ([f"id {servo}" for servo in twice], "two servos with", "give each servo an id of its own"),
        (mistaken, "wrong model:", "check the wiring file and the ids: two servos may have changed places"),
        (old, "firmware too old:", f"update it to {LEAST_FIRMWARE} or newer with the vendor's wizard"),
    ]
    wrong = [(f"{what} {named(which)}", fix) for which, what, fix in troubles if which]
    notes = [(f"not in the wiring: {named(foreign)}", "add it to the wiring file or take it off the bus")] * bool(
        foreign
    )
    if answers.damaged:
        notes.append(
            (f"{answers.damaged} answers were damaged", "two servos may have the same id, or the cable is bad")
        )
    kinds = Counter(servo.name for _, servo in here)
    summary = f"{len(here)} of {len(joints)} servos answer"
    if here:
        firmware = sorted({servo.firmware for _, servo in here})
        counted = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
        summary += f" ({counted}, firmware {', '.join(map(str, firmware))})"
    return Finding(
        check=f"scan of bus {bus}",
        verdict=Verdict.WRONG if wrong else Verdict.ATTENTION if notes else Verdict.GOOD,
        found="; ".join([summary, *(text for text, _ in wrong + notes)]),
        fix="; ".join(fix for _, fix in wrong + notes),
        figures={
            "wired": len(joints),
            "answered": len(here),
            "missing": missing,
            "foreign": foreign,
            "twice": twice,
            "wrong_model": mistaken,
            "old_firmware": old,
            "damaged": answers.damaged,
        },
    )
