"""Settings of the stereo terrain perception (ICRA'17 III-D)."""

from typing import Annotated, Literal, get_args

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0.0)]
Fraction = Annotated[float, Field(ge=0.0, le=1.0)]
PlaneMode = Literal["robust", "paper"]
PLANE_MODES: tuple[PlaneMode, ...] = get_args(PlaneMode)


class _Settings(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class MatchingConfig(_Settings):
    """Semi-global matching at the working resolution."""

    scale: Annotated[float, Field(gt=0.0, le=1.0)] = 0.5  # of the camera's picture: 320 x 240 of 640 x 480
    disparities: Annotated[int, Field(ge=16, multiple_of=16)] = 64
    block: Annotated[int, Field(ge=1)] = 5  # px
    uniqueness: Annotated[int, Field(ge=0)] = 8  # percent by which the best cost beats the second
    left_right_difference: Annotated[int, Field(ge=0)] = 1  # px both directions may differ by
    speckle_area: Annotated[int, Field(ge=0)] = 100  # px; smaller islands of disparity are mistakes
    largest_difference: Positive = 0.5  # of a window's variance, by which both eyes may differ: 0.05 is usual
    picture_noise: Annotated[float, Field(ge=0.0)] = 4.5  # grey values by which they may differ besides
    disparity_sigma: Positive = 0.24  # px, measured on rendered rough ground at 320 x 240
    smallest_disparity: Positive = 6.0  # px; beyond it a point says little about centimetres


CLOSE_MATCHING = MatchingConfig(scale=1.0, disparities=128, speckle_area=400, smallest_disparity=12.0)
"""Full resolution, 640 x 480, over the same depths."""


class GridConfig(_Settings):
    """Disparities to the highest point of each cell, and the gates on the way."""

    cell: Positive = 0.02  # m
    reach: Positive = 1.6  # m from the camera along the ground; height sigma there is about 1 cm
    height_gate: Positive = 0.22  # m above or below the plane of the feet, at the robot
    gate_slope: Annotated[float, Field(ge=0.0)] = 0.3  # the gate opens with distance: 17 degrees of slope pass
    headroom: Positive = 1.0  # m above the ground up to which what hangs overhead matters to a robot of 0.33 m
    min_points: Annotated[int, Field(ge=1)] = 2
    companions: Annotated[int, Field(ge=0)] = 7  # cells of the 24 about one that must lie near its height
    companion_step: Positive = 0.04  # m that counts as near
    top_band: Positive = 0.015  # m under a cell's highest point that count as its top


class PatchConfig(_Settings):
    """The patch ahead about the size of the footprint, in m from the camera along the heading."""

    near: Positive = 0.3
    far: Positive = 0.9
    width: Positive = 0.8
    min_coverage: Fraction = 0.25  # of its cells; with fewer the ground is unknown


class FeatureConfig(_Settings):
    """Weights a_i and norms of eqs. 7 and 8; the paper sets them empirically and prints none.

    With these, roughness is 1 where the centre line average is about 2.5 cm, as on the roughest 10 cm blocks of the
    paper's testbed (height difference 113 % of the clearance), and step height is 1 for steps of 9 cm about the mean
    plane, 18 cm from lowest to highest.
    """

    edge_height: Positive = 0.02  # m between neighbours of a cell pair that is an edge
    roughness_weights: tuple[float, float, float, float, float] = (8.0, 4.0, 1.2, 0.6, 0.2)
    roughness_norm: Positive = 0.5
    peak_weight: float = 1.0  # a_6
    edge_weight: float = 1.0  # a_7
    step_norm: Positive = 0.09  # m, half of 113 % of the clearance


class HealthConfig(_Settings):
    """Where each measure of picture quality counts as bad (0) and good (1).

    Set on rendered ground: a tenth of the light, thick fog or rows 2 px apart fall below `smallest` while nine of ten
    heights are still right to 2 cm; motion blur of 15 px costs little and 41 px half.
    """

    contrast: tuple[float, float] = (1.0, 6.0)  # grey levels, median local standard deviation
    sharpness: tuple[float, float] = (0.15, 0.60)  # horizontal and vertical detail relative to contrast
    consistency: tuple[float, float] = (0.45, 0.78)  # mean correlation of matched windows
    row_error: tuple[float, float] = (0.9, 0.4)  # px between the rows of the eyes
    density: tuple[float, float] = (0.25, 0.60)  # fraction of ground pixels with a match
    smallest: Fraction = 0.3  # below it nothing is concluded from a frame


class FeltConfig(_Settings):
    """The ground as the feet and the body feel it.

    Three measures, each turned into the deviation of heights (m) that goes with it: where the feet stand, how the load
    of a leg changes from stance to stance, and how the body's tilt, averaged over a stride, changes from stride to
    stride. What level ground gives at any gait is taken off. Gains and noise were set on simulated walks over the
    testbed's segments and level ground, 0.4 to 1.4 Hz and 620 to 2500 N/m.
    """

    memory: Positive = 15.0  # s that a foothold counts once its foot has left it
    radius: Positive = 0.5  # m about the body within which it counts: the feet and half a stride
    fewest: Annotated[int, Field(ge=5)] = 6  # footholds: a hexapod that stands
    noise: Positive = 0.002  # m of a foothold's height, measured on level ground
    load_noise: Positive = 3.0  # N that the gait itself changes a leg's load by, median
    load_gain: Positive = 0.005  # m per N beyond it
    tilt_noise: Positive = 0.003  # rad that a stride's mean tilt changes by, as on level ground
    tilt_gain: Positive = 1.0  # m per rad beyond it
    strides: Annotated[int, Field(ge=2)] = 2  # whose changes of load and tilt count
    weights: tuple[Fraction, Fraction, Fraction] = (0.6, 0.1, 0.3)  # of footholds, loads and tilt


class PerceptionConfig(_Settings):
    """The stage as a whole. `mode` paper is the literal chain: plain least squares, no gates on the plane."""

    mode: PlaneMode = "robust"
    foot_depth: Positive = 0.165  # m, the soles under the body's origin when standing
    matching: MatchingConfig = MatchingConfig()
    close_matching: MatchingConfig = CLOSE_MATCHING
    grid: GridConfig = GridConfig()
    patch: PatchConfig = PatchConfig()
    features: FeatureConfig = FeatureConfig()
    health: HealthConfig = HealthConfig()
    felt: FeltConfig = FeltConfig()
