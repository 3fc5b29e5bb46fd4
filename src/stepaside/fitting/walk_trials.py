"""Walk trials: short walks in simulation that rate steadiness."""

from dataclasses import replace
from math import degrees, radians
from typing import Any, NamedTuple

import numpy as np

from ..core.errors import StepAsideError
from ..core.poses import Array
from ..games.game import GameInPlay, GameObserver, play
from ..games.outcome import Outcome
from ..games.physics_world import PhysicsWorld
from ..games.recorded_game import RecordedGame
from ..games.robot_player import RobotPlayer
from ..games.robot_settings import settings_from_description
from ..games.walk_settings import WalkSettings
from ..locomotion.control_settings import ControlSettings
from ..planning import GaitSettings
from ..robots.description import RobotDescription

CYCLES = 8  # gait cycles of a walk after its first step
START_TIME = 2.5  # time for standing and start-up transients, in [s]
GREATEST_TILT = 8.0  # of the torso in a steady walk, in [deg]
GREATEST_COM_ERROR = 0.06  # rms in a steady walk, by the CoM height
GREATEST_DEVIATION = 0.15  # relative, of speed and turning from the plan
FALLEN = 10.0  # unsteadiness of a walk that ends in a fall
STANDING_FROM = 0.3  # time at which transients have settled, in [s]
STANDING_UNTIL = 0.6  # time before which no robot starts walking, in [s]


class JointStrain(NamedTuple):
    """Joint loads of a robot in a walk."""

    standing: float  # greatest fraction of a torque limit while standing
    standing_joint: str
    walking: float  # greatest fraction of a torque limit while walking
    walking_joint: str
    saturated: float  # fraction of ticks with a joint at its torque limit
    sag: float  # mean deficit of the CoM height while standing [m]


class StrainGauge(GameObserver):
    """Observer that measures the joint strain of the only player."""

    def __init__(self) -> None:
        """Begin without data."""
        self._loads: list[Array] = []
        self._sags: list[float] = []
        self._names: list[str] = []
        self._limits = np.zeros(0)
        self._standing = 0  # ticks

    def acted(self, game: GameInPlay) -> None:
        """Record the actuator forces of this tick."""
        world = game.world
        assert isinstance(world, PhysicsWorld)
        model, data, now = world.model, world.data, world.time
        if now < STANDING_FROM:
            return
        if not self._names:
            self._names = [
                model.joint(joint).name.split("/", 1)[1]
                for joint in model.actuator_trnid[:, 0]
            ]
            limits = model.actuator_forcerange[:, 1]
            self._limits = np.where(limits > 0.0, limits, np.inf)
        self._loads.append(np.abs(data.actuator_force) / self._limits)
        if now < STANDING_UNTIL:
            self._standing += 1
            (walker,) = world.players
            assert isinstance(walker, RobotPlayer)
            height = walker.scheme.walk.reference.com[2]
            actual = float(walker.truth.position_com_in_world[2])
            self._sags.append(height - actual)

    def strain(self) -> JointStrain:
        """Return the strain so far."""
        if not self._loads:
            return JointStrain(0.0, "", 0.0, "", 0.0, 0.0)
        loads = np.array(self._loads)
        standing = loads[: self._standing].max(axis=0, initial=0.0)
        walking = loads.max(axis=0)
        return JointStrain(
            float(standing.max()),
            self._names[int(standing.argmax())],
            float(walking.max()),
            self._names[int(walking.argmax())],
            float((loads > 0.999).any(axis=1).mean()),
            float(np.mean(self._sags)) if self._sags else 0.0,
        )


class TrialPath(NamedTuple):
    """Path of a walk trial."""

    name: str
    backward: bool
    bearing: float  # desired heading [rad]


PATHS = (
    TrialPath("forward", False, 0.0),
    TrialPath("backward", True, 0.0),
    TrialPath("turning left", False, radians(45.0)),
    TrialPath("backward, sharply left", True, radians(90.0)),
    TrialPath("backward, sharply right", True, radians(-90.0)),
)


class WalkTrial(NamedTuple):
    """Walk of a robot along a path, with its own or other settings."""

    description: RobotDescription
    gait: GaitSettings
    control: ControlSettings
    path: TrialPath


class WalkTrialResult(NamedTuple):
    """Result of a walk trial."""

    way: str  # name of the path
    feedback: bool
    message: str
    completed: bool = False
    lasted: float = 0.0  # fraction of the duration that was walked
    # greatest tilt of the torso [deg]; None after an early fall
    tilt: float | None = None
    # rms error of the CoM by its height; None likewise
    strays: float | None = None
    speed: float | None = None  # speed by that of the plan; None likewise
    # turning by that of the plan; None also for a straight path
    turning: float | None = None
    # joint strain; None if the walk could not begin
    strain: JointStrain | None = None
    # commanded lean of the torso [deg], which adds to the tilt
    lean: float = 0.0

    def to_json(self) -> dict[str, Any]:
        """Return the result as values for JSON."""
        strain = self.strain
        return self._asdict() | {
            "steady": self.is_steady,
            "unsteadiness": self.unsteadiness,
            "strain": None if strain is None else strain._asdict(),
        }

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
    """Return control settings with or without feedback."""
    method = control.method if feedback else "closed-form"
    if feedback and not control.feedback:
        method = "measured"
    return replace(control, method=method, feedback=feedback)


def trials_of(
    description: RobotDescription, *, feedback: bool
) -> tuple[WalkTrial, ...]:
    """Return the walk trials of a robot along all paths."""
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
        return WalkTrialResult(path.name, feedback, str(error))
    play(game)
    run = game.run()
    summary, tracking = run.summary, run.summary.tracking
    errors = [
        axis.rms for axis in (tracking.com_x_m, tracking.com_y_m) if axis
    ]
    return WalkTrialResult(
        path.name,
        feedback,
        run.message,
        run.outcome is Outcome.COMPLETED,
        run.duration / duration,
        summary.tilt_max_deg,
        max(errors) / gait.com_height if len(errors) == 2 else None,
        summary.speed_ratio,
        summary.yaw_ratio if path.bearing else None,
        gauge.strain(),
        degrees(trial.description.lean),
    )
