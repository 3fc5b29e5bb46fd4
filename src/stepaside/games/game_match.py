"""Games of any number of players, played from their settings."""

from collections.abc import Callable
from math import hypot
from time import perf_counter

import numpy as np

from ..core.poses import Array
from ..sim.ground_truth import torsos_apart
from .floor_games import play_floor
from .game import ARRIVAL, Progress
from .game_evaluation import GameRecord, summarise_game
from .game_settings import GameSettings
from .game_starts import with_starts
from .game_world import GameWorld
from .match import Match, MatchObserver, play
from .outcome import Outcome
from .recorder import Recorder
from .run import MatchRun
from .trajectory import PlanningTimes, Trajectory


class GameMatch(Match):
    """Match of any number of players in physics.

    It ends with a fall or a contact of a robot, or when all players with a
    goal and a strategy have reached their goals.

    Attributes:
        settings: Settings of the game, with the initial poses filled in.
        recorder: Recorder of the trajectories.
        goals_at: Time at which players reached their goals, in [s], by name.
    """

    def __init__(
        self,
        settings: GameSettings,
        observers: tuple[MatchObserver, ...] = (),
        *,
        recorded: bool = True,
        rendered: bool = False,
    ) -> None:
        """Build the world and place the players in it.

        Args:
            settings: Settings of the game.
            observers: Observers in addition to the recorder.
            recorded: Whether to record; the record grows with time.
            rendered: Whether to render the world of the game.

        Raises:
            StepAsideError: If the settings contradict each other or cannot
                be met by the robots.
        """
        self.settings = settings = with_starts(settings)
        stage = GameWorld(settings, rendered=rendered)
        tick = stage.world.physics.tick
        self.recorder = Recorder(stage.players, tick=tick)
        self.goals_at: dict[str, float] = {}
        self._goals = {
            own.name: own.goal
            for own in settings.players
            if own.goal and own.decides
        }
        super().__init__(
            stage.world,
            stage.players,
            (*((self.recorder,) if recorded else ()), *observers),
            has_things=settings.room is not None,
            networks=stage.networks,
        )

    @property
    def distance(self) -> float | None:
        """Smallest distance between a robot and another player, in [m]."""
        robots = set(self.settings.robots)
        return min(
            (
                torsos_apart(one.truth, other.truth)
                for number, one in enumerate(self.players)
                for other in self.players[:number]
                if one.name in robots or other.name in robots
            ),
            default=None,
        )

    def _judge(self) -> Outcome | None:
        """Apply the rules; the game also ends when all goals are reached."""
        for name, goal in self._goals.items():
            if name not in self.goals_at:
                truth = self.player(name).truth
                x, y = truth.position_reference_in_world
                if hypot(x - goal[0], y - goal[1]) < ARRIVAL:
                    self.goals_at[name] = self.world.time
        ended = super()._judge()
        if (
            ended is None
            and self._goals
            and self.goals_at.keys() == (self._goals.keys())
        ):
            self.message = f"all goals reached at {self.world.time:.2f} s"
            return Outcome.COMPLETED
        return ended

    def run(self, outcome: Outcome, wall_time: float) -> MatchRun:
        """Return the finished game as a value.

        Args:
            outcome: How it ended.
            wall_time: Time that the computation took, in [s].
        """
        return make_match_run(
            GameRecord(
                self.settings,
                outcome,
                self.message,
                round(self.world.time, 9),
                self.recorder.times,
                self.recorder.tracks(),
                self.recorder.planning(),
                self.goals_at,
                self.touched,
                self.fallen,
            ),
            wall_time,
        )


def make_match_run(record: GameRecord, wall_time: float) -> MatchRun:
    """Return the run of a finished game.

    Args:
        record: What was recorded of it.
        wall_time: Time that the computation took, in [s].
    """
    return MatchRun(
        name=f"game-seed{record.settings.seed}",
        settings=record.settings,
        outcome=record.outcome,
        message=record.message,
        duration=record.duration,
        times=record.times,
        tracks=record.tracks,
        summary=summarise_game(record, wall_time),
    )


def run_game(
    settings: GameSettings,
    report: Callable[[Progress], None] | None = None,
) -> MatchRun:
    """Play a game at its level to its end.

    Args:
        settings: Settings of the game.
        report: Called about five times a second with the progress. A
            KeyboardInterrupt while playing ends the game; the part that was
            played is returned.

    Returns:
        The run. Equal settings give equal runs, except for computing times.

    Raises:
        StepAsideError: If the settings contradict each other or cannot be
            met by the players.
    """
    if settings.level != "physics":
        return _run_templates(settings, report)
    match = GameMatch(settings)
    outcome, wall_time = play(match, settings.duration, report)
    return match.run(outcome, wall_time)


def _run_templates(
    settings: GameSettings, report: Callable[[Progress], None] | None
) -> MatchRun:
    """Play a game of templates."""
    settings = with_starts(settings)
    began = perf_counter()
    game, recorder = play_floor(settings, report)
    assert game.ended is not None
    poses = recorder.poses()
    none = PlanningTimes(0, np.zeros(0), 0.0, None)
    return make_match_run(
        GameRecord(
            settings,
            game.ended.outcome,
            game.ended.message,
            round(game.world.time, 9),
            np.array(recorder.times),
            {name: _track(rows) for name, rows in poses.items()},
            dict.fromkeys(poses, none),
            game.goals_at,
            game.ended.players
            if game.ended.outcome is Outcome.TOUCHED
            else (),
            (),
        ),
        perf_counter() - began,
    )


def _track(poses: Array) -> Trajectory:
    """Return the trajectory of a template, whose CoM is on the floor."""
    poses = poses.copy()
    poses[:, 2] = np.unwrap(poses[:, 2])
    com = np.column_stack([poses[:, :2], np.zeros(len(poses))])
    return Trajectory(com=com, torso=poses.copy(), place=poses)
