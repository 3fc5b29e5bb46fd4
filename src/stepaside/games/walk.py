"""One robot that walks, and somebody who pushes it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf

import mujoco

from ..control.balance.mpc import MpcResult
from ..control.balance.settings import ControlSettings
from ..errors import ConfigurationError, check_positive, check_within
from ..planning import Direction, GaitSettings
from ..poses import Array, Pose
from ..robots.description import load_robot
from ..sensing.measurement import Sighting
from ..strategies import Walk
from ..world.body_settings import BodySettings, with_cycle
from ..world.push import Push
from ..world.settings import PhysicsSettings
from ..world.world import World
from .match import Match, Observer, play
from .outcome import Outcome
from .standing import stand_walker
from .track import margin_of
from .walk_record import WalkRecorder

NAME = "walker"
ERROR = ConfigurationError


@dataclass(frozen=True, slots=True)
class WalkSettings:
    """Everything that decides a walk.

    Attributes:
        seed: Seed of every random draw.
        duration: Simulated time, in [s].
        robot: Name of a robot or folder of its description.
        bearing: Desired heading in the frame of each support foot, in
            [rad]: 0 walks straight on, others in a circle.
        backward: Whether it walks backward.
        gait: How it walks.
        physics: Physics, floor and clock.
        body: How far its body is from an ideal one.
        control: How it controls its walk.
        pushes: Who bumps into it.
    """

    seed: int = 1
    duration: float = 20.0
    robot: str = "nao"
    bearing: float = 0.0
    backward: bool = False
    gait: GaitSettings = field(default_factory=GaitSettings)
    physics: PhysicsSettings = field(default_factory=PhysicsSettings)
    body: BodySettings = field(default_factory=BodySettings)
    control: ControlSettings = field(default_factory=ControlSettings)
    pushes: tuple[Push, ...] = ()

    def __post_init__(self) -> None:
        """Refuse a negative seed and a duration that is none."""
        check_within(self.seed, 0, 2**63, "seed", "1", ERROR)
        check_positive(self.duration, "duration", "s", ERROR)
        check_within(self.bearing, -3.2, 3.2, "bearing", "rad", ERROR)


@dataclass(frozen=True, slots=True, eq=False)
class WalkRun:
    """A walk as it went.

    Attributes:
        settings: What decided it.
        outcome: How it ended.
        message: What ended it, in words.
        duration: Simulated time, in [s].
        arrays: The record, by name; see :class:`WalkRecorder`.
        steps: Footsteps made.
        adapted: Footsteps that feedback moved.
        zmp_margin: Least ZMP margin of the plans walked, in [m].
        answers: Of the solver of the MPC, if there is one.
        push_impulse: Impulse given, in [N s], in the world.
        wall_time: Time that it took, in [s].
    """

    settings: WalkSettings
    outcome: Outcome
    message: str
    duration: float
    arrays: dict[str, Array]
    steps: int
    adapted: int
    zmp_margin: float | None
    answers: tuple[MpcResult, ...]
    push_impulse: tuple[float, float]
    wall_time: float


class Walking(Match):
    """One robot in a world, ready to walk.

    Attributes:
        settings: What decides the walk.
        walker: Who walks.
        recorder: What keeps the record.
    """

    def __init__(
        self, settings: WalkSettings, *, recorded: bool = True
    ) -> None:
        """Build the world and stand the robot in it.

        Args:
            settings: What decides the walk.
            recorded: Whether to keep what the figures need.

        Raises:
            StepAsideError: If the settings ask for what cannot be.
        """
        self.settings = settings
        description = load_robot(settings.robot)
        world = World(
            {NAME: description},
            with_cycle(settings.physics, settings.body),
            settings.body,
            settings.seed,
        )
        back, ahead = Direction.BACKWARD, Direction.FORWARD
        self.walker = stand_walker(
            world,
            NAME,
            description,
            Pose(0.0, 0.0, 0.0),
            Walk(settings.bearing, back if settings.backward else ahead),
            gait=settings.gait,
            control=settings.control,
            body=settings.body,
            seed=settings.seed,
            sighting=Sighting(0.0, 0.0, inf),
        )
        mujoco.mj_forward(world.model, world.data)
        if settings.pushes:
            self.walker.push(*settings.pushes)
        self.recorder = WalkRecorder(self.walker)
        observers: list[Observer] = [self.recorder] if recorded else []
        super().__init__(world, [self.walker], observers)

    def run(self, outcome: Outcome, wall_time: float) -> WalkRun:
        """What was walked, as a value.

        Args:
            outcome: How it ended.
            wall_time: Time that it took, in [s].
        """
        recorder, walker = self.recorder, self.walker
        pusher = walker.robot.pusher
        return WalkRun(
            settings=self.settings,
            outcome=outcome,
            message=self.message,
            duration=self.world.time,
            arrays=recorder.arrays(),
            steps=recorder.steps,
            adapted=walker.scheme.balance.adapted,
            zmp_margin=margin_of(recorder.plans),
            answers=tuple(recorder.solved),
            push_impulse=(0.0, 0.0) if pusher is None else pusher.impulse,
            wall_time=wall_time,
        )


def run_walk(
    settings: WalkSettings,
    report: Callable[[float], None] | None = None,
    *,
    record: bool = True,
) -> WalkRun:
    """Walk to the end, or to a fall.

    Args:
        settings: What decides the walk.
        report: Called about five times a second with the simulated time. A
            KeyboardInterrupt while walking ends the walk and keeps it.
        record: Whether to keep what the figures need.

    Raises:
        StepAsideError: If the settings ask for what cannot be.
    """
    walking = Walking(settings, recorded=record)
    told = report
    outcome, wall_time = play(
        walking,
        settings.duration,
        None if told is None else lambda progress: told(progress.time),
    )
    return walking.run(outcome, wall_time)
