"""Walk of one robot, with optional pushes."""

from collections.abc import Callable
from math import inf

import mujoco

from ..control.sight_sources import MeasuredSight
from ..core.poses import Pose
from ..locomotion.zmp.mpc import MpcResult
from ..perception.measurement import Sighting
from ..planning import Direction
from ..robots.description import RobotDescription, load_robot
from ..sim.body_settings import with_control_period
from ..sim.world import World
from ..strategies import Walk
from .game import Progress
from .match import Match, MatchObserver, play
from .outcome import Outcome
from .recorder import Recorder
from .run import WalkRun
from .walk_evaluation import StepCounts, summarise_walk
from .walk_settings import WALKER, WalkSettings
from .walker import SimulatedPlayer
from .walker_factory import RobotSensing, WalkerSetup, place_walker


class WalkCounts:
    """Match observer that counts steps and collects solver results.

    Attributes:
        steps: Steps begun so far.
        solved: Results of the MPC so far, if there is one.
    """

    def __init__(
        self, walker: SimulatedPlayer, *, keeps_answers: bool = True
    ) -> None:
        """Observe a walker."""
        self._walker, self._keeps_answers = walker, keeps_answers
        self.steps = 0
        self.solved: list[MpcResult] = []

    def before(self, match: Match) -> None:
        """Do nothing before the players act."""

    def acted(self, match: Match) -> None:
        """Count a step that begins, and collect the solver's result."""
        walker = self._walker
        if walker.begun is not None:
            self.steps += 1
        solved = walker.scheme.state.solved
        if solved is not None and self._keeps_answers:
            self.solved.append(solved)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Do nothing at the end of the game."""


class WalkGame(Match):
    """Match of one walking robot.

    Attributes:
        settings: Settings of the walk.
        walker: The robot.
        recorder: Recorder of the trajectory.
        tally: Counter of steps and solver results.
    """

    def __init__(
        self,
        settings: WalkSettings,
        *,
        recorded: bool = True,
        description: RobotDescription | None = None,
        observers: tuple[MatchObserver, ...] = (),
    ) -> None:
        """Build the world and place the robot in it.

        Args:
            settings: Settings of the walk.
            recorded: Whether to record what the evaluation needs.
            description: Description of the robot, if it differs from that in
                its folder.
            observers: Additional observers.

        Raises:
            StepAsideError: If the settings contradict each other or cannot
                be met by the robot.
        """
        self.settings = settings = settings.resolved()
        description = description or load_robot(settings.robot)
        world = World(
            {WALKER: description},
            with_control_period(settings.physics, settings.body),
            settings.body,
            settings.seed,
        )
        back, ahead = Direction.BACKWARD, Direction.FORWARD
        self.walker = place_walker(
            world,
            WalkerSetup(
                WALKER,
                description,
                settings.gait,
                settings.control,
                settings.body,
                odometry_in_world=Pose(0.0, 0.0, 0.0),
                seed=settings.seed,
            ),
            Walk(settings.bearing, back if settings.backward else ahead),
            sensing=RobotSensing(MeasuredSight(Sighting(0.0, 0.0, inf))),
        )
        mujoco.mj_forward(world.model, world.data)
        if settings.pushes:
            self.walker.push(*settings.pushes)
        self.recorder = Recorder(
            [self.walker], tick=world.physics.tick, closely=True
        )
        self.tally = WalkCounts(self.walker, keeps_answers=recorded)
        recorders: list[MatchObserver] = [self.tally]
        if recorded:
            recorders.append(self.recorder)
        super().__init__(world, [self.walker], [*recorders, *observers])

    def run(self, outcome: Outcome, wall_time: float) -> WalkRun:
        """Return the finished walk as a value.

        Args:
            outcome: How it ended.
            wall_time: Time that the computation took, in [s].
        """
        recorder, walker = self.recorder, self.walker
        pusher = walker.robot.pusher
        times, tracks = recorder.times, recorder.tracks()
        summary = summarise_walk(
            self.settings,
            outcome,
            self.world.time,
            times,
            tracks[WALKER],
            StepCounts(
                self.tally.steps,
                walker.scheme.state.adapted,
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
            duration=round(self.world.time, 9),
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
    """Simulate a walk to its end, or to a fall.

    Args:
        settings: Settings of the walk.
        report: Called about five times a second with the simulated time. A
            KeyboardInterrupt while walking ends the walk; the part that was
            walked is returned.
        record: Whether to record what the evaluation needs.

    Raises:
        StepAsideError: If the settings contradict each other or cannot be
            met by the robot.
    """
    game = WalkGame(settings, recorded=record)

    def report_time(progress: Progress) -> None:
        if report is not None:
            report(progress.time)

    outcome, wall_time = play(game, settings.duration, report_time)
    return game.run(outcome, wall_time)
