"""Where are the feet? Reads a robot's description and follows its Denavit-Hartenberg chains from joint angles to feet.

Angles are in rad, leg by leg in the order of `joint_names`; positions are in metres in the body's frame.
"""

import numpy as np

from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body, joint_frames_in_body

robot = load_robot("weaver")
print(f"{robot.name}: {robot.leg_count} legs with {robot.joints_per_leg} joints each, {robot.mass} kg")

# All joints at zero: every leg stretched out level, as its hip points.
stretched = np.zeros(robot.joint_count)
# Femur 30 degrees up and tibia 80 degrees down, the same on all legs.
bent = np.zeros((robot.leg_count, robot.joints_per_leg))
bent[:, [2, 3]] = np.radians([-30.0, 80.0])

for name, angles in (("stretched", stretched), ("bent", bent)):
    print(f"\n{name}:")
    for leg, (x, y, z) in zip(robot.leg_names, feet_in_body(robot, angles), strict=True):
        print(f"  {leg}  x {x:+.3f}  y {y:+.3f}  z {z:+.3f} m")

# The frames along one leg tell where its knees are, for drawing or for collision checks.
frames = joint_frames_in_body(robot, bent)[robot.leg_names.index("AL")]
heights = ", ".join(f"{frame[2, 3]:+.3f}" for frame in frames)
print(f"\nheights along leg AL from hip to foot: {heights} m")
