"""Nothing is compiled while a robot moves: warming up has done it, for every robot and order."""

import subprocess
import sys

LIVES = """
from robot_agent.kinematics.compiled import _sources
from robot_agent.locomotion import warm_up
from robot_agent.locomotion.soak import soak
from weaver_shared.robots import robot_names

warm_up()
before = {kernel: len(kernel.signatures) for kernel in _sources}
assert len(before) > 50
result = soak(60 * 2 * len(robot_names()), seed=8, life=60)
assert not result.violations
print([kernel.__name__ for kernel, count in before.items() if len(kernel.signatures) > count])
"""


def test_no_robot_and_no_order_makes_a_warm_walker_compile():
    done = subprocess.run([sys.executable, "-c", LIVES], capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "[]"
