"""Half a metre on flat ground in lock step: physics, pictures, odometry, gait and safety in one deterministic process.

Nothing here waits for wall-clock time: every `step()` is one control tick of 10 ms on the simulated clock.
"""

import numpy as np

from sim_agent.lock_step import LockStep
from sim_agent.worlds import make_world
from weaver_shared.messages import CommandName, Waypoint
from weaver_shared.robots import load_robot

run = LockStep(load_robot("weaver"), make_world("flat", seed=1), seed=1)
try:
    run.step()
    # The robot decides and answers; what it refuses it refuses with a reason.
    run.operator.send(CommandName.TAKE_CONTROL)
    print(run.operator.send(CommandName.START_MISSION).reason)
    run.operator.send(CommandName.STAND)
    while run.step().walk.walk.posture != "standing":
        pass
    print(f"standing after {run.clock.now_ns() * 1e-9:.1f} s")

    run.operator.send(CommandName.SET_MISSION, waypoints=(Waypoint(x=0.5, y=0.0),))
    run.operator.send(CommandName.START_MISSION)
    for _ in range(1500):
        moment = run.step()
        if run.walk.desk.mission(moment.walk.stamp_ns).phase == "done":
            break
    believed = moment.walk.state.world_from_body.position
    true = moment.truth.position_in_world
    print(f"believes to be at {believed[0]:.2f}, {believed[1]:.2f} m after {run.clock.now_ns() * 1e-9:.1f} s")
    print(f"which is {np.linalg.norm(believed - true) * 1000:.0f} mm from the truth")
finally:
    run.close()
