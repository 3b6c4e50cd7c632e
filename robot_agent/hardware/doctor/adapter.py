"""How soon a USB adapter hands on what it has heard: many keep bytes for 16 ms, which no baud rate makes good."""

from __future__ import annotations

from pathlib import Path

from robot_agent.hardware.doctor.finding import Finding, Verdict, not_tested

USB_SERIAL = Path("/sys/bus/usb-serial/devices")
LONGEST_LATENCY = 1  # ms


def judge_adapter(bus: str, port: str, devices: Path = USB_SERIAL) -> Finding:
    """Of the adapter behind the name `port`, which may be a link to its device."""
    check = f"latency timer of bus {bus}"
    device = Path(port).resolve().name
    try:
        latency = int((devices / device / "latency_timer").read_text())
    except (OSError, ValueError):
        return not_tested(check, f"{device} tells no latency timer: it is no adapter of that kind")
    good = latency <= LONGEST_LATENCY
    return Finding(
        check=check,
        verdict=Verdict.GOOD if good else Verdict.WRONG,
        found=f"{device} hands bytes on after {latency} ms",
        fix="" if good else f"echo 1 | sudo tee {devices / device}/latency_timer, and a udev rule to make it last",
        figures={"latency_ms": latency},
    )
