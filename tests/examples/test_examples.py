"""Every example runs as a person would run it, stays short, and says what it is for."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
SAYS = {
    "forward_kinematics": r"AL  x \+0\.336  y \+0\.449  z \+0\.000 m",
    "read_terrain_features": r"A +0\.0 +0\.00 +0 .*\n(.*\n)*   C .*\n",
    "talk_on_the_bus": r"eve asks to stand: refused, eve does not hold this robot\nrobot 'nobody' does not answer",
    "walk_in_lock_step": r"believes to be at 0\.[45]\d, -?0\.0\d m after .* s\nwhich is \d\d? mm from the truth",
}


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs_and_says_what_it_should(example: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-W", "error", str(example)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    assert re.search(SAYS[example.stem], done.stdout), done.stdout


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_is_short_and_documented(example: Path) -> None:
    text = example.read_text()
    assert 20 <= len(text.splitlines()) <= 60
    assert len(ast.get_docstring(ast.parse(text)) or "") > 80
