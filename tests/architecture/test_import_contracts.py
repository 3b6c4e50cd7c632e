"""Who may import whom: the contracts of pyproject.toml, and the short list of what the shared base may use."""

import sys
from pathlib import Path

import grimp
import pytest
from importlinter.cli import EXIT_STATUS_SUCCESS, lint_imports

ROOT = Path(__file__).resolve().parents[2]
OURS = {"weaver_shared", "robot_agent", "sim_agent", "weaver_console"}
BASE_MAY_USE = {"msgspec", "numpy", "pydantic"}


@pytest.fixture(scope="module")
def imports() -> grimp.ImportGraph:
    return grimp.build_graph(*sorted(OURS), include_external_packages=True, cache_dir=None)


def test_every_import_contract_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    assert lint_imports(config_filename="pyproject.toml", cache_dir=None) == EXIT_STATUS_SUCCESS


def test_no_package_of_the_tree_escapes_the_contracts() -> None:
    found = {path.parent.name for path in [*ROOT.glob("*/__init__.py"), *ROOT.glob("shared/*/__init__.py")]}
    assert found == OURS


def test_the_base_uses_little_and_zenoh_in_the_bus_alone(imports: grimp.ImportGraph) -> None:
    for module in imports.find_matching_modules("weaver_shared") | imports.find_matching_modules("weaver_shared.**"):
        used = {name.partition(".")[0] for name in imports.find_modules_directly_imported_by(module)}
        strangers = used - OURS - BASE_MAY_USE - sys.stdlib_module_names
        assert strangers <= ({"zenoh"} if module == "weaver_shared.bus" else set()), f"{module} imports {strangers}"


def test_no_stage_takes_time_or_randomness_by_itself(imports: grimp.ImportGraph) -> None:
    stages = ["adaptation", "kinematics", "locomotion", "mapping", "navigation", "odometry", "perception", "vision"]
    for stage in stages:
        modules = imports.find_matching_modules(f"robot_agent.{stage}.**") | {f"robot_agent.{stage}"}
        for module in modules:
            used = imports.find_modules_directly_imported_by(module)
            assert not used & {"time", "random", "datetime", "socket", "threading"}, module
