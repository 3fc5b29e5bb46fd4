"""The figures of a walk: what is said of it in numbers."""

from dataclasses import asdict, dataclass
from typing import Any

from .summary_parsing import read_figures


@dataclass(frozen=True, slots=True)
class ErrorStatistics:
    """How far one quantity was from another, in the unit of both."""

    rms: float
    mean: float
    max: float


@dataclass(frozen=True, slots=True)
class TrackingErrors:
    """What was done, from what was asked, seen from the foot that stands."""

    com_x_m: ErrorStatistics | None
    com_y_m: ErrorStatistics | None
    zmp_x_m: ErrorStatistics | None
    zmp_y_m: ErrorStatistics | None


@dataclass(frozen=True, slots=True)
class EstimationErrors:
    """What was believed, from what was, seen from the foot that stands."""

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
    """How the solver of the MPC did.

    Attributes:
        solves: How often it was asked.
        infeasible: How often there was no solution.
        median_us: Processor time, in [us].
        p99_us: That of the slowest hundredth.
        iterations: Mean number.
        greatest_excess_m: How far outside its bounds a ZMP was, in [m].
    """

    solves: int
    infeasible: int
    median_us: float
    p99_us: float
    iterations: float
    greatest_excess_m: float


@dataclass(frozen=True, slots=True)
class WalkSummary:
    """Figures of a walk, after its first three seconds where it says how.

    Errors are in the frame of the support foot; speed and yaw are compared
    over whole gait cycles with what the plans asked for.

    Attributes:
        outcome: How it ended.
        message: What ended it, in words.
        seed: Of every random draw.
        duration_s: Simulated time, in [s].
        steps: Footsteps begun.
        adapted_steps: Footsteps that feedback moved.
        method: Where the plans' CoM came from.
        feedback: Whether the walk was stabilised.
        push_impulse_n_s: Impulse given in the world (x, y), in [N s].
        speed_m_s: Speed over whole gait cycles, in [m/s].
        speed_ratio: Way over what was planned.
        yaw_rate_deg_s: Rate of turn, in [deg/s].
        yaw_ratio: Turn over what was planned.
        slip_per_step_m: Mean way of the foot that stands, in [m].
        tracking: What was done, from what was asked.
        estimation: What was believed, from what was.
        tilt_max_deg: Greatest tilt of the torso, in [deg].
        min_zmp_margin_m: Least distance of a ZMP reference from the edge of
            its support polygon, in [m]; None if nobody walked.
        qp: How the solver of the MPC did, if there was one.
        real_time_factor: Simulated time over the time that it took.
        run_folder: Where the run lies, if it was written.
    """

    outcome: str
    message: str
    seed: int
    duration_s: float
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
    run_folder: str | None = None

    def to_json(self) -> dict[str, Any]:
        """Plain values by name, as ``--json`` prints them."""
        plain = asdict(self)
        plain["push_impulse_n_s"] = list(self.push_impulse_n_s)
        if self.run_folder is None:
            del plain["run_folder"]
        return plain

    @classmethod
    def from_json(cls, plain: Any, source: str) -> "WalkSummary":
        """Read what :meth:`to_json` gave.

        Args:
            plain: Plain values by name.
            source: Where they come from, for messages.

        Raises:
            ConfigurationError: If it is no such thing; names what is off.
        """
        return read_figures(cls, plain, source)
