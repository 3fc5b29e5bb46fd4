"""Short walks that say whether a robot walks, and how steadily."""

from dataclasses import dataclass, replace
from math import degrees, radians
from typing import Any, NamedTuple

from ..core.errors import StepAsideError
from ..games.match import play
from ..games.outcome import Outcome
from ..games.robot_settings import settings_of
from ..games.walk_game import WalkGame
from ..games.walk_settings import WalkSettings
from ..locomotion.zmp.control_settings import ControlSettings, Method
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from .joint_strain import JointStrain, StrainGauge

CYCLES = 8  # gait cycles of a walk after its first step
READY = 2.5  # time until a walk is judged, with feedback's pause, in [s]
TILTED = 8.0  # tilt of the torso that a steady walk keeps under, in [deg]
STRAYS = 0.06  # of the CoM's height: error of the CoM in a steady walk, rms
MISSES = 0.15  # of speed and turning against what is planned
FALLEN = 10.0  # unsteadiness of a walk that ends in a fall


class TrialPath(NamedTuple):
    """Where a robot walks.

    Attributes:
        name: In words.
        backward: Whether it walks backward.
        bearing: Heading that it steers for, in [rad].
    """

    name: str
    backward: bool
    bearing: float


WAYS = (
    TrialPath("forward", False, 0.0),
    TrialPath("backward", True, 0.0),
    TrialPath("turning left", False, radians(45.0)),
    TrialPath("backward, sharply left", True, radians(90.0)),
    TrialPath("backward, sharply right", True, radians(-90.0)),
)


@dataclass(frozen=True, slots=True)
class WalkTrial:
    """A robot, how it walks, and where.

    Attributes:
        description: Of the robot.
        gait: How it walks.
        control: How it is controlled.
        way: Where it walks.
    """

    description: RobotDescription
    gait: GaitSettings
    control: ControlSettings
    way: TrialPath


class WalkTrialResult(NamedTuple):
    """How a walk went.

    Attributes:
        way: Where it went.
        feedback: Whether with feedback.
        message: What ended it, in words.
        completed: Whether it got to its end.
        lasted: Share of the time that it lasted.
        tilt: Greatest tilt of the torso, in [deg]; None if it fell early.
        strays: Error of the CoM by its height, rms, likewise.
        speed: Speed by what was planned, likewise.
        turning: Turning by what was planned; None if it was to go straight.
        strain: What the joints bore; None if it could not begin.
        lean: Of the torso on purpose, in [deg], which is no tilt.
    """

    way: str
    feedback: bool
    message: str
    completed: bool
    lasted: float
    tilt: float | None
    strays: float | None
    speed: float | None
    turning: float | None
    strain: JointStrain | None
    lean: float = 0.0

    @property
    def is_steady(self) -> bool:
        """Whether it walked to the end, upright and where it was to."""
        return self.completed and self.unsteadiness < 1.0

    @property
    def unsteadiness(self) -> float:
        """Greatest part of what a steady walk may do; more after a fall."""
        if not self.completed:
            return FALLEN + 1.0 - self.lasted
        parts = [
            (self.tilt or 0.0) / (TILTED + self.lean),
            (self.strays or 0.0) / STRAYS,
            abs((self.speed or 0.0) - 1.0) / MISSES,
            0.0 if self.turning is None else abs(self.turning - 1.0) / MISSES,
        ]
        return max(parts)


def control_with(control: ControlSettings, feedback: bool) -> ControlSettings:
    """Control with feedback, or without.

    Args:
        control: What holds besides.
        feedback: Which.
    """
    method: Method = control.method if feedback else "closed-form"
    if feedback and not control.feedback:
        method = "measured"
    return replace(control, method=method, feedback=feedback)


def trials_of(
    description: RobotDescription, *, feedback: bool
) -> tuple[WalkTrial, ...]:
    """Walks of a robot to all sides.

    Args:
        description: Of the robot.
        feedback: Whether with feedback.

    Raises:
        StepAsideError: If it says what no robot can do.
    """
    own = settings_of(description)
    control = control_with(own.control, feedback)
    return tuple(
        WalkTrial(description, own.gait, control, way) for way in WAYS
    )


def walk_trial(trial: WalkTrial) -> WalkTrialResult:
    """Walk one walk; what cannot begin is told in its message."""
    gait, way = trial.gait, trial.way
    feedback = trial.control.feedback
    duration = READY + gait.start_support + 2 * CYCLES * gait.step_duration
    settings = WalkSettings(
        duration=duration,
        robot=str(trial.description.folder),
        bearing=way.bearing,
        backward=way.backward,
        gait=gait,
        control=trial.control,
    )
    gauge = StrainGauge()
    try:
        walking = WalkGame(
            settings, description=trial.description, observers=(gauge,)
        )
    except StepAsideError as error:
        nothing = (None,) * 5
        return WalkTrialResult(
            way.name, feedback, str(error), False, 0.0, *nothing
        )
    outcome, wall = play(walking, duration)
    run = walking.run(outcome, wall)
    summary = run.summary.to_json()
    return WalkTrialResult(
        way.name,
        feedback,
        run.message,
        outcome is Outcome.COMPLETED,
        run.duration / duration,
        summary["tilt_max_deg"],
        _strays(summary, gait),
        summary["speed_ratio"],
        summary["yaw_ratio"] if way.bearing else None,
        gauge.strain(),
        degrees(trial.description.lean),
    )


def _strays(summary: dict[str, Any], gait: GaitSettings) -> float | None:
    """Error of the CoM by its height, the greater of both axes."""
    tracking = summary["tracking"]
    errors = [tracking[f"com_{axis}_m"] for axis in "xy"]
    if any(error is None for error in errors):
        return None
    return float(max(e["rms"] for e in errors) / gait.com_height)
