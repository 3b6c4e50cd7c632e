"""What the packages import is what pyproject.toml asks for, and every version is pinned once."""

import re
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

import grimp
import pytest

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
OURS = {"weaver_shared", "robot_agent", "sim_agent", "weaver_console"}
EXTRAS = {
    "weaver_shared": [],
    "robot_agent": ["robot", "study", "analysis"],
    "sim_agent": ["robot", "sim", "study"],
    "weaver_console": ["console", "analysis"],
}


def canonical(name: str) -> str:
    return re.sub(r"[-_.]+", "-", re.split(r"[\[<>=~! ]", name)[0]).lower()


def pinned() -> dict[str, str]:
    lines = [line for line in (ROOT / "constraints.txt").read_text().splitlines() if not line.startswith("#")]
    return dict(line.split("==") for line in lines)


def test_constraints_are_names_and_versions_only() -> None:
    lines = [line for line in (ROOT / "constraints.txt").read_text().splitlines() if not line.startswith("#")]
    assert all(re.fullmatch(r"[a-z0-9-]+==[0-9][0-9a-z.]*", line) for line in lines)
    names = [line.split("==")[0] for line in lines]
    assert len(names) == len(set(names))


def test_everything_asked_for_is_pinned() -> None:
    asked = {canonical(name) for name in PROJECT["dependencies"]}
    asked |= {canonical(name) for extra in PROJECT["optional-dependencies"].values() for name in extra}
    assert asked <= set(pinned())


def test_one_distribution_owns_opencv() -> None:
    assert set(packages_distributions()["cv2"]) == {"opencv-python-headless"}
    assert pinned()["opencv-python"] == "0"


@pytest.mark.parametrize("package", sorted(OURS))
def test_every_import_is_declared(package: str) -> None:
    declared = {canonical(name) for name in PROJECT["dependencies"]}
    for extra in EXTRAS[package]:
        declared |= {canonical(name) for name in PROJECT["optional-dependencies"][extra]}
    graph = grimp.build_graph(*sorted(OURS), include_external_packages=True, cache_dir=None)
    owners = packages_distributions()
    for module in graph.find_matching_modules(f"{package}.**"):
        for imported in graph.find_modules_directly_imported_by(module):
            name = imported.partition(".")[0]
            if name in OURS or name in sys.stdlib_module_names:
                continue
            providers = {canonical(owner) for owner in owners.get(name, [name])}
            assert providers & declared, f"{module} imports {name}, which no dependency of {package} brings"
