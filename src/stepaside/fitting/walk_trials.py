"""Walk trials: short walks in simulation that rate steadiness."""

from dataclasses import dataclass, replace
from math import degrees, radians
from typing import NamedTuple

from ..core.errors import StepAsideError
from ..games.game import play
from ..games.outcome import Outcome
from ..games.recorded_game import RecordedGame
from ..games.robot_settings import settings_from_description
from ..games.walk_settings import WalkSettings
from ..games.walk_summary import WalkSummary
from ..locomotion.zmp.control_settings import ControlSettings
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from .joint_strain import JointStrain, StrainGauge

CYCLES = 8  # gait cycles of a walk after its first step
START_TIME = 2.5  # time for standing and start-up transients, in [s]
GREATEST_TILT = 8.0  # of the torso in a steady walk, in [deg]
GREATEST_COM_ERROR = 0.06  # rms in a steady walk, by the CoM height
GREATEST_DEVIATION = 0.15  # relative, of speed and turning from the plan
FALLEN = 10.0  # unsteadiness of a walk that ends in a fall


class TrialPath(NamedTuple):
    """Path of a walk trial.

    Attributes:
        name: Name of the path.
        backward: Whether the robot walks backward.
        bearing: Desired heading, in [rad].
    """

    name: str
    backward: bool
    bearing: float


PATHS = (
    TrialPath("forward", False, 0.0),
    TrialPath("backward", True, 0.0),
    TrialPath("turning left", False, radians(45.0)),
    TrialPath("backward, sharply left", True, radians(90.0)),
    TrialPath("backward, sharply right", True, radians(-90.0)),
)


@dataclass(frozen=True, slots=True)
class WalkTrial:
    """Definition of a walk trial.

    Attributes:
        description: Robot description.
        gait: Gait settings.
        control: Control settings.
        path: Path of the walk.
    """

    description: RobotDescription
    gait: GaitSettings
    control: ControlSettings
    path: TrialPath


class WalkTrialResult(NamedTuple):
    """Result of a walk trial.

    Attributes:
        way: Name of the path.
        feedback: Whether feedback was used.
        message: Message of the outcome.
        completed: Whether the walk was completed.
        lasted: Fraction of the duration that was walked.
        tilt: Greatest tilt of the torso, in [deg]; None after an early fall.
        strays: Rms error of the CoM by its height; None likewise.
        speed: Speed by that of the plan; None likewise.
        turning: Turning by that of the plan; None also for a straight path.
        strain: Joint strain; None if the walk could not begin.
        lean: Commanded lean of the torso, in [deg], which adds to the tilt.
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
        """Whether the walk was completed with all criteria met."""
        return self.completed and self.unsteadiness < 1.0

    @property
    def unsteadiness(self) -> float:
        """Greatest criterion by its limit; 10 to 11 after a fall."""
        if not self.completed:
            return FALLEN + 1.0 - self.lasted
        parts = [
            (self.tilt or 0.0) / (GREATEST_TILT + self.lean),
            (self.strays or 0.0) / GREATEST_COM_ERROR,
            abs((self.speed or 0.0) - 1.0) / GREATEST_DEVIATION,
        ]
        if self.turning is not None:
            parts.append(abs(self.turning - 1.0) / GREATEST_DEVIATION)
        return max(parts)


def control_with(control: ControlSettings, feedback: bool) -> ControlSettings:
    """Return control settings with or without feedback.

    Args:
        control: Control settings to change.
        feedback: Whether to use feedback.
    """
    method = control.method if feedback else "closed-form"
    if feedback and not control.feedback:
        method = "measured"
    return replace(control, method=method, feedback=feedback)


def trials_of(
    description: RobotDescription, *, feedback: bool
) -> tuple[WalkTrial, ...]:
    """Return the walk trials of a robot along all paths.

    Args:
        description: Robot description.
        feedback: Whether to use feedback.

    Raises:
        StepAsideError: If its settings are invalid.
    """
    own = settings_from_description(description)
    control = control_with(own.control, feedback)
    return tuple(
        WalkTrial(description, own.gait, control, path) for path in PATHS
    )


def walk_trial(trial: WalkTrial) -> WalkTrialResult:
    """Run a walk trial; an invalid one has an error message as its result."""
    gait, path = trial.gait, trial.path
    duration = (
        START_TIME + gait.start_support + 2 * CYCLES * gait.step_duration
    )
    settings = WalkSettings(
        duration=duration,
        robot=str(trial.description.folder),
        bearing=path.bearing,
        backward=path.backward,
        gait=gait,
        control=trial.control,
    ).resolved()
    feedback = bool(settings.control.feedback)
    gauge = StrainGauge()
    try:
        game = RecordedGame(settings, (gauge,), description=trial.description)
    except StepAsideError as error:
        return WalkTrialResult(
            path.name,
            feedback,
            str(error),
            completed=False,
            lasted=0.0,
            tilt=None,
            strays=None,
            speed=None,
            turning=None,
            strain=None,
        )
    play(game)
    run = game.run()
    summary = run.summary
    return WalkTrialResult(
        path.name,
        feedback,
        run.message,
        run.outcome is Outcome.COMPLETED,
        run.duration / duration,
        summary.tilt_max_deg,
        _com_error(summary, gait),
        summary.speed_ratio,
        summary.yaw_ratio if path.bearing else None,
        gauge.strain(),
        degrees(trial.description.lean),
    )


def _com_error(summary: WalkSummary, gait: GaitSettings) -> float | None:
    """Return the rms CoM error by its height, the greater of both axes."""
    sagittal, coronal = summary.tracking.com_x_m, summary.tracking.com_y_m
    if sagittal is None or coronal is None:
        return None
    return max(sagittal.rms, coronal.rms) / gait.com_height
