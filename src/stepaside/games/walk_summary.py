"""Summary of a walk."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ErrorStatistics:
    """Statistics of the difference of two quantities, in their unit."""

    rms: float
    mean: float
    max: float


@dataclass(frozen=True, slots=True)
class TrackingErrors:
    """True values minus references, in the frame of the support foot."""

    com_x_m: ErrorStatistics | None
    com_y_m: ErrorStatistics | None
    zmp_x_m: ErrorStatistics | None
    zmp_y_m: ErrorStatistics | None


@dataclass(frozen=True, slots=True)
class EstimationErrors:
    """Estimates minus true values, in the frame of the support foot."""

    com_x_m: ErrorStatistics | None
    com_y_m: ErrorStatistics | None
    velocity_x_m_s: ErrorStatistics | None
    velocity_y_m_s: ErrorStatistics | None
    zmp_x_m: ErrorStatistics | None
    zmp_y_m: ErrorStatistics | None
    roll_rad: ErrorStatistics | None
    pitch_rad: ErrorStatistics | None


@dataclass(frozen=True, slots=True)
class SolverSummary:
    """Performance of the solver of the MPC.

    Attributes:
        solves: Number of problems.
        infeasible: Number of problems without a solution.
        median_us: Median processor time, in [us].
        p99_us: 99 % quantile of the processor time, in [us].
        iterations: Mean number of iterations.
        greatest_excess_m: Greatest violation of a bound of the ZMP, in [m].
    """

    solves: int
    infeasible: int
    median_us: float
    p99_us: float
    iterations: float
    greatest_excess_m: float


@dataclass(frozen=True, slots=True)
class WalkSummary:
    """Summary of a walk.

    Errors are in the frame of the support foot; speed and yaw rate are
    compared with the plans over whole gait cycles. All motion is evaluated
    after the first three seconds.

    Attributes:
        seed: Seed of every random draw.
        steps: Footsteps begun.
        adapted_steps: Footsteps that feedback adapted.
        method: Method that gives the CoM of the plans.
        feedback: Whether the walk was stabilised.
        push_impulse_n_s: Sum of all impulses in the world (x, y), in [N s].
        speed_m_s: Speed over whole gait cycles, in [m/s].
        speed_ratio: Path length over the planned one.
        yaw_rate_deg_s: Yaw rate, in [deg/s].
        yaw_ratio: Turn over the planned one.
        slip_per_step_m: Mean slip of the support foot, in [m].
        tracking: Errors of CoM and ZMP from their references.
        estimation: Errors of the estimates.
        tilt_max_deg: Greatest tilt of the torso, in [deg].
        min_zmp_margin_m: Smallest distance of a ZMP reference from the edge
            of its support polygon, in [m]; None if the robot did not walk.
        qp: Performance of the solver of the MPC, if there was one.
        real_time_factor: Simulated time over computing time.
    """

    seed: int
    steps: int
    adapted_steps: int
    method: str
    feedback: bool
    push_impulse_n_s: tuple[float, float]
    speed_m_s: float | None
    speed_ratio: float | None
    yaw_rate_deg_s: float | None
    yaw_ratio: float | None
    slip_per_step_m: float | None
    tracking: TrackingErrors
    estimation: EstimationErrors
    tilt_max_deg: float | None
    min_zmp_margin_m: float | None
    qp: SolverSummary | None
    real_time_factor: float
