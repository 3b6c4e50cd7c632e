"""Settings of the stereo-inertial odometry. Pixels are those of the raw pictures; the rest is SI."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0.0)]
Count = Annotated[int, Field(gt=0)]


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class FrontEndConfig(_Model):
    """Finding and following corners."""

    features: Annotated[int, Field(ge=20, le=400)] = 130
    columns: Count = 8  # of the detection grid
    rows: Count = 6
    spacing: Positive = 18.0  # px between two features
    fast_threshold: Count = 12  # grey values
    border: Count = 12  # px at the picture's edge without features
    window: Count = 13  # px, side of the tracked square
    levels: Count = 3  # of the pyramid above the picture itself, while nobody knows where to look
    predicted_levels: Count = 1  # once predictions have proved right
    surprise: Positive = 3.0  # px, median error of the prediction that makes it wrong
    same_view: Positive = 12.0  # px, median motion of the features up to which an earlier picture is searched from
    largest_correction: Positive = 1.0  # px; a feature found farther off from there is another one
    epipolar_gate: Positive = 1.5  # px
    nearest: Positive = 0.15  # m, stereo matches closer than this are wrong
    dark_mean: Positive = 8.0  # a picture whose mean is below is black
    flat_deviation: Positive = 2.0  # a picture whose standard deviation is below shows nothing


class WindowConfig(_Model):
    """The sliding window (measured choice: 8 keyframes and the 3 newest frames)."""

    keyframes: Annotated[int, Field(ge=3, le=12)] = 8
    recent: Annotated[int, Field(ge=2, le=4)] = 3
    keyframe_overlap: Annotated[float, Field(gt=0.0, le=1.0)] = 0.85  # a new keyframe sees less of the last one
    keyframe_interval: Positive = 5.0  # s, the longest stretch of inertia between keyframes
    iterations: Count = 2
    pixel_sigma: Positive = 0.5
    correlation: Annotated[float, Field(ge=0.0)] = 4.0  # sigma per error left after solving, 0: pixel_sigma whatever is
    huber: Positive = 1.0  # sigma
    gate: Positive = 4.5  # sigma, beyond it an observation is wrong
    parallax: Positive = 0.02  # rad between two rays before they make a point
    time_offset_sigma: Annotated[float, Field(ge=0.0)] = 0.001  # s, 0 fixes the calibrated offset
    rig_turn_sigma: Annotated[float, Field(ge=0.0)] = 0.001  # rad, of the eyes on the IMU; 0 fixes the calibration
    rig_shift_sigma: Annotated[float, Field(ge=0.0)] = 0.0005  # m, likewise


class StartConfig(_Model):
    """Beginning at rest, or in motion when rest does not come."""

    rest_duration: Positive = 0.5  # s at rest to begin with
    patience: Positive = 1.0  # s of waiting for rest before beginning in motion
    gyro_bias_sigma: Positive = 0.01  # rad/s, in motion; at rest it follows from the noise
    accel_bias_sigma: Positive = 0.05  # m/s^2, 1 sigma of the turn-on bias
    moving_tilt_sigma: Positive = 0.05  # rad
    moving_velocity_sigma: Positive = 0.3  # m/s


class RestConfig(_Model):
    """Standstill: what the IMU and the pictures may show of it."""

    duration: Positive = 0.4  # s looked at
    gyro_deviation: Positive = 0.012  # rad/s, standard deviation of each axis
    gyro_mean: Positive = 0.01  # rad/s, after the bias is known
    accel_deviation: Positive = 0.12  # m/s^2
    shaken_gyro_deviation: Positive = 0.15  # rad/s, likewise of a body that stands but trembles (motors, rotors)
    shaken_accel_deviation: Positive = 2.0  # m/s^2
    flow: Positive = 0.35  # px, median between frames
    seen_duration: Positive = 0.6  # s over which the view must not have moved either
    seen_motion: Positive = 0.3  # px, median over that time
    velocity_sigma: Positive = 0.003  # m/s
    rotation_sigma: Positive = 3.0e-4  # rad against the previous frame
    position_sigma: Positive = 3.0e-4  # m against the previous frame


class FeetConfig(_Model):
    """The way over standing feet. Measured in simulation: 7 mm/m on blocks, 0.4 mm noise of a foot's reading."""

    settling: Annotated[float, Field(ge=0.0)] = 0.03  # s a foot must have stood before it counts
    slip_speed: Positive = 0.1  # m/s by which a foot may differ from the others
    slip_way: Positive = 1.5e-3  # m, likewise between two readings however close
    reading_sigma: Positive = 7e-4  # m, of a way's two ends
    slip_density: Positive = 5e-3  # m/sqrt(s), of all standing feet together
    guess_speed: Positive = 0.1  # m/s, error of the way while fewer than two feet agree
    longest_guess: Positive = 0.3  # s without two feet after which nothing is known
    huber: Positive = 2.0  # sigma


class FailureConfig(_Model):
    """When an estimate is degraded or lost."""

    good_features: Count = 25  # fewer than this: degraded
    least_features: Count = 8  # fewer than this: the frame is blind
    blind_duration: Positive = 3.0  # s of inertia alone before the pose counts as lost
    imu_gap: Positive = 0.05  # s between two samples
    clock_jump: Positive = 1.0  # s back, or forth without any sample, after which the clock is another one
    least_matched: Annotated[float, Field(ge=0.0, le=1.0)] = 0.2  # of the features in the other eye, or they disagree
    greatest_speed: Positive = 5.0  # m/s
    greatest_gyro: Positive = 8.7  # rad/s; at the end of its range (500 degrees/s) a sensor tells less than there was
    greatest_accel: Positive = 78.0  # m/s^2; likewise (8 g of a 3DM-GX5)


class OdometryConfig(_Model):
    front_end: FrontEndConfig = FrontEndConfig()
    window: WindowConfig = WindowConfig()
    start: StartConfig = StartConfig()
    rest: RestConfig = RestConfig()
    feet: FeetConfig = FeetConfig()
    failure: FailureConfig = FailureConfig()
