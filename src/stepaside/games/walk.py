"""One robot that walks, and somebody who pushes it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import ceil, inf
from time import perf_counter

import mujoco

from ..control import Phase
from ..control.balance.mpc import MpcResult
from ..control.balance.settings import ControlSettings
from ..errors import (
    ConfigurationError,
    ReachError,
    check_positive,
    check_within,
)
from ..planning import Direction, GaitSettings
from ..poses import Array, Pose
from ..robots.description import load_robot
from ..sensing.measurement import Sighting
from ..strategies.roles import Walk
from ..world.body_settings import BodySettings
from ..world.push import Push
from ..world.settings import PhysicsSettings
from ..world.world import World
from .assembly import assemble, with_cycle
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


@dataclass(frozen=True, slots=True)
class WalkResult:
    """A walk as it went.

    Attributes:
        settings: What decided it.
        outcome: "completed", "fall" or "interrupted".
        duration: Simulated time, in [s].
        arrays: The record, by name; see :class:`WalkRecorder`.
        steps: Footsteps made.
        adapted: Footsteps that feedback moved.
        margins: Least ZMP margin of each plan walked, in [m].
        answers: Of the solver of the MPC, if there is one.
        push_impulse: Impulse given, in [N s], in the world.
        wall_time: Time that it took, in [s].
    """

    settings: WalkSettings
    outcome: str
    duration: float
    arrays: dict[str, Array]
    steps: int
    adapted: int
    margins: list[float]
    answers: list[MpcResult]
    push_impulse: tuple[float, float]
    wall_time: float


class Walker:
    """One robot in a world, ready to walk.

    Attributes:
        settings: What decides the walk.
        world: The physics.
        robot: The robot.
        scheme: What drives it.
    """

    def __init__(self, settings: WalkSettings) -> None:
        """Build the world and stand the robot in it.

        Raises:
            StepAsideError: If the settings ask for what cannot be.
        """
        self.settings = settings
        description = load_robot(settings.robot)
        self.world = World(
            {NAME: description},
            with_cycle(settings.physics, settings.body),
            settings.body,
            settings.seed,
        )
        direction = (
            Direction.BACKWARD if settings.backward else Direction.FORWARD
        )
        self.robot, self.scheme = assemble(
            self.world,
            NAME,
            description,
            Pose(0.0, 0.0, 0.0),
            Walk(settings.bearing, direction),
            gait=settings.gait,
            control=settings.control,
            body=settings.body,
            seed=settings.seed,
            sighting=Sighting(0.0, 0.0, inf),
        )
        mujoco.mj_forward(self.world.model, self.world.data)
        if settings.pushes:
            self.robot.push(*settings.pushes)

    def tick(self) -> bool:
        """Walk for one control tick; false if the robot fell."""
        robot = self.robot
        try:
            targets = self.scheme.update(robot.read())
        except ReachError:
            # Legs that cannot follow any more belong to a robot that falls.
            return False
        robot.write(targets)
        robot.step()
        fallen = self.scheme.phase is Phase.FALLEN
        return not (fallen or robot.truth.has_fallen)


def run_walk(
    settings: WalkSettings,
    report: Callable[[float], None] | None = None,
    *,
    record: bool = True,
) -> WalkResult:
    """Walk to the end, or to a fall.

    Args:
        settings: What decides the walk.
        report: Called about five times a second with the simulated time. A
            KeyboardInterrupt while walking ends the walk and keeps it.
        record: Whether to keep what the summary needs.

    Raises:
        StepAsideError: If the settings ask for what cannot be.
    """
    walker = Walker(settings)
    recorder = WalkRecorder(walker.robot, walker.scheme)
    world = walker.world
    ticks = ceil(settings.duration / world.physics.tick - 1e-9)
    outcome = "completed"
    began = told = perf_counter()
    try:
        while world.ticks < ticks:
            if not walker.tick():
                outcome = "fall"
                break
            if record and world.ticks % recorder.every == 0:
                recorder.sample()
            if report is not None and world.ticks % 50 == 0:
                now = perf_counter()
                if now - told > 0.2:
                    told = now
                    report(world.time)
    except KeyboardInterrupt:
        outcome = "interrupted"
    scheme, pusher = walker.scheme, walker.robot.pusher
    feedback = scheme.stabiliser
    return WalkResult(
        settings=settings,
        outcome=outcome,
        duration=world.time,
        arrays=recorder.arrays(),
        steps=len(scheme.landings),
        adapted=feedback.adapted if feedback else 0,
        margins=scheme.margins if record else [],
        answers=feedback.zmp_feedback.answers if feedback else [],
        push_impulse=(0.0, 0.0) if pusher is None else pusher.impulse,
        wall_time=perf_counter() - began,
    )
