"""A built wheel is whole: installed elsewhere, without the tree, it has its commands, its robots and its page."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path
from urllib.parse import urljoin
from urllib.request import urlopen

import pytest

ROOT = Path(__file__).resolve().parents[2]
PARTS = ("robot_agent", "sim_agent", "weaver_console", "shared", "pyproject.toml", "setup.py", "README.md", "web/dist")

pytestmark = pytest.mark.skipif(
    not (ROOT / "web" / "dist" / "index.html").is_file(), reason="the page is not built; ./weaver test builds it"
)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    for part in PARTS:
        source, target = ROOT / part, folder / "tree" / part
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target)
    pip("wheel", str(folder / "tree"), "--no-deps", "--no-build-isolation", "--wheel-dir", str(folder))
    (built,) = folder.glob("weaver_hexapod-*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A fresh environment with the wheel; what it depends on is borrowed from this one."""
    place = tmp_path_factory.mktemp("environment")
    venv.create(place, with_pip=False)
    packages = place / "lib" / f"python{sys.version_info.major}.{sys.version_info.minor}" / "site-packages"
    # A .pth file's folders are searched, but their own .pth files (our editable install) are not read.
    (packages / "borrowed.pth").write_text(sysconfig.get_path("purelib"))
    pip("--python", str(place / "bin" / "python"), "install", "--no-deps", "--no-index", str(wheel))
    return place


def pip(*arguments: str) -> None:
    done = subprocess.run([sys.executable, "-m", "pip", *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def environment() -> dict[str, str]:
    return {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}


def run(place: Path, *command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command, cwd=place, env=environment(), capture_output=True, text=True, check=False, timeout=120
    )


def test_the_wheel_holds_page_robots_and_every_module(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    assert "weaver_console/_web/index.html" in names
    assert any(name.startswith("weaver_console/_web/assets/") and name.endswith(".js") for name in names)
    for package in ("robot_agent", "sim_agent", "weaver_console", "shared/weaver_shared"):
        for pattern in ("*.py", "*.toml", "*.glsl"):
            for path in (ROOT / package).rglob(pattern):
                assert str(path.relative_to(ROOT)).removeprefix("shared/") in names
    assert not {name.partition("/")[0] for name in names} & {"tests", "web", "shared", "docs", "examples"}


def test_the_installed_command_knows_every_subcommand_without_the_tree(installed: Path) -> None:
    done = run(installed, "bin/weaver", "--help")
    assert done.returncode == 0, done.stderr
    here = run(ROOT, str(Path(sys.executable).parent / "weaver"), "--help")
    assert done.stdout == here.stdout
    assert "  up\n" in done.stdout


def test_nothing_is_imported_from_the_tree(installed: Path) -> None:
    code = (
        "import weaver_shared, robot_agent, sim_agent, weaver_console as w; print(weaver_shared.__file__, w.__file__)"
    )
    done = run(installed, "bin/python", "-c", code)
    assert done.returncode == 0, done.stderr
    assert str(ROOT) not in done.stdout


def test_the_installed_robots_load(installed: Path) -> None:
    done = run(installed, "bin/python", "-c", "from weaver_shared.robots import load_robot; print(load_robot().name)")
    assert done.stdout == "weaver\n", done.stderr


def test_the_installed_console_serves_the_page(installed: Path) -> None:
    command = ["bin/weaver", "console", "--port", "0", "--listen", "tcp/127.0.0.1:0", "--no-scene"]
    with subprocess.Popen(command, cwd=installed, env=environment(), stdout=subprocess.PIPE, text=True) as console:
        try:
            assert console.stdout is not None
            address = console.stdout.readline().split()[-1]
            page = fetch(address)
            assert "<title>Weaver Console</title>" in page
            script = re.search(r'src="(/assets/[^"]+\.js)"', page)
            assert script is not None
            assert len(fetch(urljoin(address, script[1]))) > 100_000
        finally:
            console.terminate()


def fetch(address: str) -> str:
    with urlopen(address, timeout=30.0) as reply:
        return str(reply.read().decode())
