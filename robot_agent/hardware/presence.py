"""Whether everything that a wiring names is on this computer: said all at once, and with what to do."""

from __future__ import annotations

import os
from pathlib import Path

from robot_agent.hardware.cameras.aravis import aravis
from weaver_shared.config.hardware import GenicamCameras, HardwareConfig
from weaver_shared.errors import ResourceError

BY_NAME = Path("/dev/serial/by-id")


def require_devices(config: HardwareConfig, by_name: Path = BY_NAME) -> None:
    """Raises ResourceError with a sentence for each thing that is missing. Opens nothing."""
    lines = [(f"bus {bus.name}", bus.port) for bus in config.buses]
    if config.imu is not None:
        lines.append(("the IMU", config.imu.port))
    if config.power is not None:
        lines.append(("the power monitor", config.power.port))
    found = [reason for what, port in lines if (reason := _lacking(what, Path(port)))]
    if isinstance(config.cameras, GenicamCameras):
        try:
            aravis()
        except ResourceError as error:
            found.append(str(error))
    if any("is not there" in reason for reason in found):
        there = sorted(path.name for path in by_name.iterdir()) if by_name.is_dir() else []
        found.append(
            f"in {by_name} there are {', '.join(there)}"
            if there
            else f"no serial adapter is plugged in ({by_name} is empty)"
        )
    if found:
        raise ResourceError("; ".join(found))


def _lacking(what: str, port: Path) -> str:
    if not port.exists():
        return f"{what}: port {port} is not there; plug it in and switch it on, or correct `port` in the wiring file"
    if not os.access(port, os.R_OK | os.W_OK):
        return f"{what}: port {port} may not be used by you; join its group (dialout on Debian) and log in anew"
    return ""
