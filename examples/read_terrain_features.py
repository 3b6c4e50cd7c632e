"""What roughness and step height say: the features of 0.6 x 0.8 m patches of the testbed, segment after segment.

The heights are the world's own, without a camera, so this shows the measure and not the perception. Lengths are in m.
"""

import numpy as np

from robot_agent.adaptation.polynomials import gait_for
from robot_agent.perception.features import patch_features, roughness_of, step_height_of
from robot_agent.perception.ground_plane import fit_plane
from sim_agent.worlds import make_world
from weaver_shared.config.adaptation import AdaptationConfig
from weaver_shared.config.perception import FeatureConfig

CELL = 0.02
world = make_world("testbed", seed=1)
features, adaptation = FeatureConfig(), AdaptationConfig()

print("segment  f1 mm  edges  peak mm | roughness  step height | stiffness N/m  frequency Hz  height cm")
for centre in np.arange(1.0, 8.8, 0.9):
    x, y = np.meshgrid(centre + np.arange(-0.3, 0.3, CELL), np.arange(-0.4, 0.4, CELL), indexing="ij")
    z = np.asarray(world.elevation(x, y), dtype=np.float64)

    # Features are taken about the patch's own plane: a slope alone is not rough (ICRA'17 III-D).
    plane = fit_plane(x.ravel(), y.ravel(), z.ravel(), "robust")
    residual = plane.residual(x.ravel(), y.ravel(), z.ravel()).reshape(x.shape)
    f = patch_features(residual, CELL, noise=0.0, config=features)
    roughness, step_height = roughness_of(f, features), step_height_of(f, features)
    gait = gait_for(roughness, step_height, adaptation)
    print(
        f"   {world.segment_at(centre) or '-'}    {1000 * f[0]:6.1f} {f[3]:6.2f} {1000 * f[5]:7.0f}  |"
        f" {roughness:8.2f} {step_height:11.2f}   |"
        f" {gait['virtual_stiffness']:10.0f} {gait['stride_frequency']:13.2f} {100 * gait['stride_height']:11.1f}"
    )
