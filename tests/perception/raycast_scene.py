"""Stereo pictures of a height map by marching rays: an independent renderer to test perception against."""

from dataclasses import dataclass

import numpy as np
from numba import njit

from robot_agent.vision.camera import StereoCalibration
from weaver_shared.messages import OdometryEstimate, OdometryQuality, StereoFrame
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose

NODE = 0.005  # m between the nodes of the height map
TEXEL = 0.0025  # m


@dataclass(frozen=True, kw_only=True)
class Scene:
    """Heights over x, y in -0.5..3.5, -2..2 m with a random texture seen from above."""

    heights: np.ndarray
    texture: np.ndarray

    @staticmethod
    def of(elevation, seed=0):
        x = np.arange(-0.5, 3.5, NODE) + 0.5 * NODE
        y = np.arange(-2.0, 2.0, NODE) + 0.5 * NODE
        heights = elevation(*np.meshgrid(x, y, indexing="ij"))
        rng = np.random.default_rng(seed)
        texture = np.zeros((1600, 1600))
        for block, weight in ((2, 25.0), (5, 20.0), (16, 20.0), (50, 15.0)):
            coarse = rng.normal(0.0, weight, (1600 // block, 1600 // block))
            texture[: len(coarse) * block, : len(coarse) * block] += np.kron(coarse, np.ones((block, block)))
        return Scene(heights=heights.astype(np.float64), texture=np.clip(texture + 120.0, 5.0, 250.0))

    def frame(self, world_from_body, *, noise=1.0, seed=1, stamp_ns=0):
        calibration = StereoCalibration.of_robot(load_robot())
        rng = np.random.default_rng(seed)
        eyes = []
        for eye in (calibration.left, calibration.right):
            pose = world_from_body @ eye.body_from_camera
            picture = _march(
                self.heights, self.texture, pose.rotation, pose.position, eye.fx, eye.cx, eye.cy, eye.height, eye.width
            )
            picture = picture + rng.normal(0.0, noise, picture.shape)
            eyes.append(np.clip(np.rint(picture), 0, 255).astype(np.uint8))
        return StereoFrame(stamp_ns=stamp_ns, sequence=0, left=eyes[0], right=eyes[1])


def standing(x=0.0, z=0.165, rotation=None):
    return Pose(rotation=np.eye(3) if rotation is None else rotation, position=np.array([x, 0.0, z]))


def odometry_at(pose, quality=OdometryQuality.GOOD, stamp_ns=0):
    return OdometryEstimate.at_rest(pose, stamp_ns, quality)


@njit(cache=True)
def _march(heights, texture, rotation, position, focal, cx, cy, height, width):
    picture = np.full((height, width), 180.0)
    for v in range(height):
        for u in range(width):
            a, b = (u - cx) / focal, (v - cy) / focal
            dx = rotation[0, 0] * a + rotation[0, 1] * b + rotation[0, 2]
            dy = rotation[1, 0] * a + rotation[1, 1] * b + rotation[1, 2]
            dz = rotation[2, 0] * a + rotation[2, 1] * b + rotation[2, 2]
            depth, step = 0.15, 0.004
            while depth < 4.0:
                x, y, z = position[0] + depth * dx, position[1] + depth * dy, position[2] + depth * dz
                i, j = int((x + 0.5) / NODE), int((y + 2.0) / NODE)
                if i < 0 or j < 0 or i >= heights.shape[0] or j >= heights.shape[1]:
                    break
                if z <= heights[i, j]:
                    low, high = depth - step, depth
                    for _ in range(12):
                        middle = 0.5 * (low + high)
                        i = int((position[0] + middle * dx + 0.5) / NODE)
                        j = int((position[1] + middle * dy + 2.0) / NODE)
                        if position[2] + middle * dz <= heights[i, j]:
                            high = middle
                        else:
                            low = middle
                    x, y, z = position[0] + high * dx, position[1] + high * dy, position[2] + high * dz
                    # Height enters the texture's place so that walls are textured too.
                    s = (x + 0.5 + 0.7 * z) / TEXEL % 1599.0
                    t = (y + 2.0 + 0.4 * z) / TEXEL % 1599.0
                    m, n = int(s), int(t)
                    fs, ft = s - m, t - n
                    picture[v, u] = (1 - fs) * ((1 - ft) * texture[m, n] + ft * texture[m, n + 1]) + fs * (
                        (1 - ft) * texture[m + 1, n] + ft * texture[m + 1, n + 1]
                    )
                    break
                depth += step
    return picture
