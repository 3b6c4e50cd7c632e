"""Standard output belongs to the command's own answer."""

import subprocess
import sys

PROGRAM = """
from sim_agent.body import SimulatedBody
from sim_agent.worlds import make_world
from weaver_shared.robots import load_robot
body = SimulatedBody(load_robot(), make_world("testbed", 1), 1)
body.wait_next()
body.close()
print("done")
"""


def test_a_simulation_prints_nothing_of_its_own() -> None:
    run = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=120, check=True)
    assert run.stdout == "done\n"
    assert run.stderr == ""
