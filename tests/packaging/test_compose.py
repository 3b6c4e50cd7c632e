"""The compose file is valid, starts only commands that exist with options they take, and leaves nothing open."""

import importlib
import shutil
import subprocess
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
SERVICES: dict[str, dict[str, Any]] = yaml.safe_load((ROOT / "docker-compose.yml").read_text())["services"]


GUARDED: dict[str, dict[str, Any]] = yaml.safe_load((ROOT / "docker-compose.guarded.yml").read_text())["services"]


def test_the_guarded_bus_is_between_the_same_parts() -> None:
    assert set(GUARDED) <= set(SERVICES)


@pytest.mark.parametrize(
    "command",
    [service["command"] for services in (SERVICES, GUARDED) for service in services.values()],
    ids=lambda command: " ".join(command)[:40],
)
def test_every_service_runs_a_command_that_takes_its_options(command: list[str]) -> None:
    name, *options = command
    (entry,) = entry_points(group="weaver.commands", name=name)
    module = importlib.import_module(entry.module)
    module._parser().parse_args(options)


def test_router_and_console_always_run_and_robots_by_profile() -> None:
    assert {name: service.get("profiles", []) for name, service in SERVICES.items()} == {
        "router": [],
        "console": [],
        "sim": ["sim"],
        "robot": ["robot"],
    }


def test_no_service_listens_beyond_this_computer() -> None:
    for service in SERVICES.values():
        assert "ports" not in service
        assert not any("0.0.0.0" in option for option in service["command"])


def test_the_image_is_built_from_files_that_exist() -> None:
    copied = [line.split()[1:-1] for line in (ROOT / "Dockerfile").read_text().splitlines() if line.startswith("COPY ")]
    sources = [source for line in copied for source in line if not source.startswith(("--", "/"))]
    assert sources
    assert [source for source in sources if not (ROOT / source).exists()] == []
    allowed = (ROOT / ".dockerignore").read_text().splitlines()
    assert all(f"!{source.split('/')[0]}" in allowed for source in sources)


def compose() -> list[str] | None:
    for command in (["docker", "compose"], ["docker-compose"]):
        program = shutil.which(command[0])
        if program and subprocess.run([*command, "version"], capture_output=True, check=False).returncode == 0:
            return command
    return None


@pytest.mark.skipif(compose() is None, reason="neither docker compose nor docker-compose is here")
def test_compose_accepts_the_file() -> None:
    command = [*(compose() or []), "--profile", "sim", "--profile", "robot", "config", "--quiet"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
