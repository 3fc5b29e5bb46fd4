"""One robot that walks, and somebody who pushes it."""

from collections.abc import Callable
from math import inf

import mujoco

from ..core.poses import Pose
from ..locomotion.zmp.mpc import MpcResult
from ..perception.measurement import Sighting
from ..planning import Direction
from ..robots.description import RobotDescription, load_robot
from ..robots.jit import prefer_for
from ..sim.body_settings import with_cycle
from ..sim.world import World
from ..strategies import Walk
from .match import Match, MatchObserver, play
from .outcome import Outcome
from .recorder import Recorder
from .walk_evaluation import StepCounts, summarise_walk
from .walk_run import WalkRun
from .walk_settings import WALKER, WalkSettings
from .walker import Walker
from .walker_factory import stand_walker


class WalkTally:
    """Counts steps, and keeps what a solver answered.

    Attributes:
        steps: Steps begun so far.
        solved: Answers of the MPC so far, if there is one.
    """

    def __init__(self, walker: Walker, *, keeps_answers: bool = True) -> None:
        """Count for a robot that walks."""
        self._walker, self._keeps_answers = walker, keeps_answers
        self.steps = 0
        self.solved: list[MpcResult] = []

    def before(self, match: Match) -> None:
        """Nothing to do."""

    def acted(self, match: Match) -> None:
        """Note what began, and what a solver answered."""
        walker = self._walker
        if walker.begun is not None:
            self.steps += 1
        solved = walker.scheme.balance.solved
        if solved is not None and self._keeps_answers:
            self.solved.append(solved)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Nothing to do."""


class WalkGame(Match):
    """One robot in a world, ready to walk.

    Attributes:
        settings: What decides the walk.
        walker: Who walks.
        recorder: What keeps the record.
        tally: What counts.
    """

    def __init__(
        self,
        settings: WalkSettings,
        *,
        recorded: bool = True,
        description: RobotDescription | None = None,
        observers: tuple[MatchObserver, ...] = (),
    ) -> None:
        """Build the world and stand the robot in it.

        Args:
            settings: What decides the walk.
            recorded: Whether to keep what the figures need.
            description: Of the robot, if it is another one than its folder
                has.
            observers: Who looks on besides.

        Raises:
            StepAsideError: If the settings ask for what cannot be.
        """
        self.settings = settings
        description = description or load_robot(settings.robot)
        world = World(
            {WALKER: description},
            with_cycle(settings.physics, settings.body),
            settings.body,
            settings.seed,
        )
        back, ahead = Direction.BACKWARD, Direction.FORWARD
        self.walker = stand_walker(
            world,
            WALKER,
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
        self.recorder = Recorder(
            [self.walker], tick=world.physics.tick, closely=True
        )
        self.tally = WalkTally(self.walker, keeps_answers=recorded)
        kept: list[MatchObserver] = [self.tally]
        if recorded:
            kept.append(self.recorder)
        super().__init__(world, [self.walker], [*kept, *observers])

    def run(self, outcome: Outcome, wall_time: float) -> WalkRun:
        """What was walked, as a value.

        Args:
            outcome: How it ended.
            wall_time: Time that it took, in [s].
        """
        recorder, walker = self.recorder, self.walker
        pusher = walker.robot.pusher
        times, tracks = recorder.times, recorder.tracks()
        summary = summarise_walk(
            self.settings,
            outcome,
            self.message,
            self.world.time,
            times,
            tracks[WALKER],
            StepCounts(
                self.tally.steps,
                walker.scheme.balance.adapted,
                (0.0, 0.0) if pusher is None else pusher.impulse,
                recorder.planning()[WALKER].zmp_margin,
                tuple(self.tally.solved),
                wall_time,
            ),
        )
        return WalkRun(
            name=f"walk-seed{self.settings.seed}",
            settings=self.settings,
            outcome=outcome,
            message=self.message,
            duration=summary.duration_s,
            times=times,
            tracks=tracks,
            summary=summary,
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
    prefer_for(settings.duration)
    walking = WalkGame(settings, recorded=record)
    told = report
    outcome, wall_time = play(
        walking,
        settings.duration,
        None if told is None else lambda progress: told(progress.time),
    )
    return walking.run(outcome, wall_time)
