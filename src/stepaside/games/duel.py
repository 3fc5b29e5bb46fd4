"""The game of pursuit and evasion, played in physics (paper, Sec. IV)."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from math import ceil, pi
from time import perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple

import mujoco
import numpy as np

from ..control import ControlScheme, Phase
from ..poses import Array, Pose
from ..randomness import named_generator
from ..robots.description import RobotDescription, load_robot
from ..strategies.roles import Pursuit, Role
from ..world.robot import SimulatedRobot
from ..world.sight import IdealLineOfSight
from ..world.world import World
from .assembly import assemble, with_cycle
from .people import furnisher_of, meet, stand_person, walkers_of
from .record import Recorder
from .settings import DuelSettings
from .start import draw_start

if TYPE_CHECKING:
    from .judge import Still
    from .seeing import Seeing

NAMES = ("pursuer", "evader")
CHECK_NEAR = 0.8  # torsos farther apart than two arm spans cannot touch, [m]


class Outcome(Enum):
    """How a duel ended."""

    COMPLETED = "completed"
    FALL = "fall"
    CONTACT = "contact"
    INTERRUPTED = "interrupted"


class Progress(NamedTuple):
    """How far a duel has come.

    Attributes:
        time: Simulated time, in [s].
        distance: Between the torsos, in [m].
        real_time_factor: Simulated time over time passed.
    """

    time: float
    distance: float
    real_time_factor: float


@dataclass(frozen=True, slots=True)
class DuelResult:
    """A duel as it went.

    Attributes:
        settings: What decided it, with the start that was drawn.
        outcome: How it ended.
        message: What ended it, in words.
        duration: Simulated time, in [s].
        arrays: The record, by name; see :class:`Recorder`.
        min_distance: Least distance between the torsos, in [m].
        triggered_at: When the evader began to evade, in [s]; None if never.
        triggered_distance: True distance then, in [m].
        sight: How well they saw, if with cameras.
        stills: Some of what they saw, by robot and camera.
        replans: Maneuvers planned by both.
        planning_times: Processor time of each, in [s].
        velocity_jump: Greatest jump of a CoM velocity reference, in [m/s].
        zmp_margin: Least distance of a ZMP reference from the edge of its
            support polygon, in [m]; None if nobody walked.
        wall_time: Time that it took, in [s].
    """

    settings: DuelSettings
    outcome: Outcome
    message: str
    duration: float
    arrays: dict[str, Array]
    min_distance: float
    triggered_at: float | None
    triggered_distance: float | None
    sight: dict[str, Any] | None
    stills: "dict[str, dict[str, list[Still]]]"
    replans: int
    planning_times: Array
    velocity_jump: float
    zmp_margin: float | None
    wall_time: float


class Duel:
    """Two robots in a world, ready to play.

    Attributes:
        settings: What decides the duel, with the start that was drawn.
        world: The physics.
        robots: Pursuer and evader.
        schemes: What drives them.
        seeing: What they see with, if with cameras.
    """

    def __init__(self, settings: DuelSettings) -> None:
        """Build the world and stand the robots in it.

        Raises:
            StepAsideError: If the settings ask for what cannot be.
        """
        start = draw_start(settings)
        self.settings = settings = replace(settings, start=start)
        assert start.distance is not None
        assert start.pursuer_offset is not None
        assert start.evader_offset is not None
        description = load_robot(settings.robot)
        self.seeing = _seeing(settings, description)
        self.world = World(
            dict.fromkeys(walkers_of(settings), description),
            with_cycle(settings.physics, settings.body),
            settings.body,
            settings.seed,
            furnisher_of(settings, self.seeing),
        )
        frames = (
            Pose(0.0, 0.0, start.pursuer_offset),
            Pose(start.distance, 0.0, pi + start.evader_offset),
        )
        roles: tuple[Role, Role] = (Pursuit(), settings.strategy.role())
        self.schemes: list[ControlScheme] = []
        self.robots: list[SimulatedRobot] = []
        for name, role, frame in zip(NAMES, roles, frames, strict=True):
            if name not in walkers_of(settings):
                person, mind = stand_person(self.world, name, settings, frames)
                self.robots.append(person)
                self.schemes.append(mind)
                continue
            robot, scheme = assemble(
                self.world,
                name,
                description,
                frame,
                role,
                gait=settings.gait,
                control=settings.control,
                body=settings.body,
                seed=settings.seed,
                perception=None
                if self.seeing is None
                else self.seeing.perceptions[name],
            )
            self.robots.append(robot)
            self.schemes.append(scheme)
        meet(self.robots)
        mujoco.mj_forward(self.world.model, self.world.data)
        if self.seeing is not None:
            self.seeing.open(self.robots)
        else:
            self._see_ideally()
        self.recorder = Recorder(self.robots, self.schemes, frames)
        self.min_distance = self.distance
        self.triggered_at: float | None = None
        self.triggered_distance: float | None = None

    def _see_ideally(self) -> None:
        """Tell each robot where the other is."""
        for own, other in (self.robots, self.robots[::-1]):
            if own.name not in walkers_of(self.settings):
                continue
            own.sight = IdealLineOfSight(
                own.truth,
                other.truth,
                self.settings.sight,
                named_generator(self.settings.seed, f"sight/{own.name}"),
            )

    @property
    def distance(self) -> float:
        """True distance between the torsos, in [m]."""
        return self.robots[0].truth.distance_to(self.robots[1].truth)

    def tick(self) -> Outcome | None:
        """Play one control tick; an outcome if it ends the duel."""
        if self.world.ticks % self.recorder.every == 0:
            self.recorder.sample()
            if self.seeing is not None:
                self.seeing.sample(self.world.time)
        for robot, scheme in zip(self.robots, self.schemes, strict=True):
            robot.write(scheme.update(robot.read()))
            robot.step()
        distance = self.distance
        if self.triggered_at is None:
            if self.schemes[1].phase is not Phase.STANDING:
                self.triggered_at = self.world.time
                self.triggered_distance = distance
        if distance < self.min_distance:
            self.min_distance = distance
        if any(robot.truth.has_fallen for robot in self.robots):
            return Outcome.FALL
        crowded = distance < CHECK_NEAR or self.settings.room.things
        if crowded and self.world.robots_touch():
            return Outcome.CONTACT
        return None


def run_duel(
    settings: DuelSettings,
    report: Callable[[Progress], None] | None = None,
) -> DuelResult:
    """Play a duel to its end.

    Args:
        settings: What decides it.
        report: Called about five times a second with the progress. A
            KeyboardInterrupt while playing ends the duel and keeps it.

    Returns:
        The duel; the same settings give the same one, but for times.

    Raises:
        StepAsideError: If the settings ask for what cannot be.
    """
    duel = Duel(settings)
    ticks = ceil(settings.duration / duel.world.physics.tick - 1e-9)
    outcome = Outcome.COMPLETED
    began = told = perf_counter()
    try:
        while duel.world.ticks < ticks:
            ended = duel.tick()
            if ended is not None:
                outcome = ended
                break
            if report is not None and duel.world.ticks % 25 == 0:
                now = perf_counter()
                if now - told > 0.2:
                    told = now
                    time = duel.world.time
                    report(Progress(time, duel.distance, time / (now - began)))
    except KeyboardInterrupt:
        outcome = Outcome.INTERRUPTED
    finally:
        for robot in duel.robots:
            robot.close()
    wall = perf_counter() - began
    duel.recorder.sample()
    schemes = duel.schemes
    return DuelResult(
        settings=duel.settings,
        outcome=outcome,
        message=_message(duel, outcome),
        duration=duel.world.time,
        arrays=duel.recorder.arrays()
        | ({} if duel.seeing is None else duel.seeing.arrays()),
        min_distance=duel.min_distance,
        triggered_at=duel.triggered_at,
        triggered_distance=duel.triggered_distance,
        sight=None if duel.seeing is None else duel.seeing.figures(),
        stills={} if duel.seeing is None else duel.seeing.stills(),
        replans=sum(s.replans for s in schemes),
        planning_times=np.concatenate(
            [np.array(s.planning_times) for s in schemes]
        ),
        velocity_jump=max(
            (jump for s in schemes for jump in s.velocity_jumps), default=0.0
        ),
        zmp_margin=min((m for s in schemes for m in s.margins), default=None),
        wall_time=wall,
    )


def _seeing(
    settings: DuelSettings, description: RobotDescription
) -> "Seeing | None":
    """Senses of a duel with cameras; an ideal one loads none of it."""
    if settings.sensing != "cameras":
        return None
    from .seeing import Seeing

    return Seeing(settings, description)


def _message(duel: Duel, outcome: Outcome) -> str:
    if outcome is Outcome.FALL:
        fallen = [r.name for r in duel.robots if r.truth.has_fallen]
        return f"{' and '.join(fallen)} fell at {duel.world.time:.2f} s"
    if outcome is Outcome.CONTACT:
        what = "the robots" if duel.distance < CHECK_NEAR else "robot, thing"
        if duel.settings.pursuer == "person":
            what = "person and robot"
        return f"{what} touched at {duel.world.time:.2f} s"
    if outcome is Outcome.INTERRUPTED:
        return f"interrupted at {duel.world.time:.2f} s"
    return f"played {duel.world.time:.2f} s"
