"""Settings of the terrain map (ICRA'17 III-E, Fig. 7)."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from weaver_shared.config.perception import FeatureConfig

Positive = Annotated[float, Field(gt=0.0)]
Fraction = Annotated[float, Field(ge=0.0, le=1.0)]


class MappingConfig(BaseModel):
    """Lengths in m; variances as standard deviations in m."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    cell: Positive = 0.02
    tile: Annotated[int, Field(ge=8)] = 32  # cells along a tile's edge
    tiles: Annotated[int, Field(ge=3)] = 11  # along the window's edge: 7.04 m, at least 3.2 m to each side
    gate: Positive = 3.0  # standard deviations an elevation may differ from the map's
    gate_slack: Annotated[float, Field(ge=0.0)] = 0.01  # m that are never an outlier: edges seen from elsewhere
    rejections: Annotated[int, Field(ge=1, le=255)] = 3  # in a row, after which the new elevation is believed
    sigma_floor: Positive = 0.002  # a cell is never known better: neighbours share this much of pose and calibration
    neighbour_noise: Positive = 0.0005  # m by which neighbours differ for no reason, however often they were seen
    drift: Annotated[float, Field(ge=0.0)] = 0.004  # m per square root of a second: odometry and the ground change
    sigma_ceiling: Positive = 0.05  # an old cell is kept, and never thought worse than this
    ray_clearance: Positive = 0.05  # m by which a line of sight must pass under a cell's top to speak against it
    contradictions: Annotated[int, Field(ge=1, le=255)] = 4  # pictures in a row, after which the cell is forgotten
    upper_decay: Fraction = 0.2  # of its height over the elevation that the upper bound loses when seen lower
    contact_sigma: Positive = 0.008  # m of a foothold's height: sole, joint play and the pose over the last second
    deform_shift: Positive = 0.01  # m in the plane, and
    deform_rise: Positive = 0.004  # m upwards, by which odometry has to change its mind before the map is deformed
    window: Annotated[int, Field(ge=5)] = 11  # cells along the square whose features make a cell's roughness
    min_coverage: Fraction = 0.3  # of that square
    query_radius: Positive = 0.45  # m about the body: the feet and a stride
    query_quantile: Fraction = 0.9  # of the circle's cells: the worst, but not ruled by one bad cell
    query_coverage: Fraction = 0.5  # of the circle that must be known
    features: FeatureConfig = FeatureConfig()
