"""Games that are played from their settings, and become runs."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import inf
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, cast

from ..locomotion.zmp.mpc import MpcResult
from ..robots.description import RobotDescription
from .duel_evaluation import summarise
from .duel_settings import DuelSettings
from .floor_games import floor_of, rules_of
from .floor_world import PERIOD, FloorRecorder, FloorWorld
from .game import GameInPlay, GameObserver, Progress, play
from .game_evaluation import GameRecord, summarise_game
from .game_settings import GameSettings
from .outcome import Outcome
from .physics_world import PhysicsWorld, RemoteControl
from .recorder import Recorder
from .robot_player import RobotPlayer
from .run import DuelRun, GameRun, MatchRun, WalkRun
from .settings_as_game import (
    PlayableSettings,
    as_game,
    complete,
    scenery_of,
    strategies_of,
)
from .trajectory import Trajectory
from .walk_evaluation import summarise_walk
from .walk_settings import WALKER, WalkSettings

if TYPE_CHECKING:
    from .camera_senses import SightObserver

Report = Callable[[Progress], None]


class RecordedGame(GameInPlay):
    """Duel, walk or game of players, with its record.

    Attributes:
        settings: Its settings, with nothing left open.
        recorder: Recorder of the trajectories.
        sight_observer: Evaluation of the perception, if sensing is by cameras.
        solved: Results of the MPC of a walk, if it has one.
    """

    def __init__(
        self,
        settings: PlayableSettings,
        observers: Sequence[GameObserver] = (),
        *,
        recorded: bool = True,
        rendered: bool = False,
        endless: bool = False,
        remote: Mapping[str, RemoteControl] = MappingProxyType({}),
        description: RobotDescription | None = None,
    ) -> None:
        """Build the world and place the players in it.

        Args:
            settings: Settings of the game.
            observers: Observers in addition to the recorder.
            recorded: Whether to record; the record grows with time.
            rendered: Whether to render the world; cameras do so anyway.
            endless: Whether the duration does not end it.
            remote: Control of the robots that other processes control, by
                name of the player.
            description: Description of the robot of a walk, if it differs
                from that in its folder.

        Raises:
            StepAsideError: If the settings contradict each other or cannot
                be met by the players.
        """
        self.settings: Any = (settings := complete(settings))
        game = as_game(settings)
        self.sight_observer: SightObserver | None = None
        self.solved: list[MpcResult] = []
        self.recorder: Recorder | FloorRecorder
        world: PhysicsWorld | FloorWorld
        if game.level == "physics":
            duel = settings if isinstance(settings, DuelSettings) else None
            world = PhysicsWorld(
                game,
                scenery_of(settings),
                rendered=rendered,
                has_things=duel.has_things if duel else None,
                remote=remote,
                strategies=strategies_of(settings),
                descriptions={WALKER: description} if description else {},
            )
            closely = isinstance(settings, WalkSettings)
            self.recorder = Recorder(world, closely=closely)
            if recorded:
                self.sight_observer = world.sight_observer(
                    duel.room.things if duel else (),
                    every=self.recorder.every,
                )
        else:
            world = floor_of(game)
            self.recorder = FloorRecorder(world, PERIOD)
        kept: list[GameObserver | None] = [self.recorder, self.sight_observer]
        if isinstance(settings, WalkSettings):
            kept.append(SolverRecorder(self.solved))
        rules = rules_of(game)
        super().__init__(
            world,
            replace(rules, duration=inf) if endless else rules,
            [*(o for o in kept if recorded and o is not None), *observers],
        )

    @property
    def in_physics(self) -> PhysicsWorld:
        """The world of a game in physics."""
        assert isinstance(self.world, PhysicsWorld)
        return self.world

    def run(self) -> GameRun[Any, Any]:
        """Return the game as a value; one that goes on is interrupted."""
        settings, recorder, eyes = self.settings, self.recorder, None
        times, tracks = recorder.times, recorder.tracks()
        if self.sight_observer is not None and isinstance(
            settings, DuelSettings
        ):
            eyes = self.sight_observer
            for name, rows in eyes.sight().items():
                tracks[name] = replace(tracks[name], sight=rows)
        return GameRun(
            name=f"{settings.game}-seed{settings.seed}",
            settings=settings,
            outcome=self.outcome or Outcome.INTERRUPTED,
            message=self.message,
            duration=round(self.world.time, 9),
            times=times,
            tracks=tracks,
            summary=self._summary(tracks),
            stills={} if eyes is None else eyes.stills(),
        )

    def _summary(self, tracks: Mapping[str, Trajectory]) -> Any:
        """Compute the summary of its kind of game."""
        record = self, self.recorder.times, tracks, self.recorder.planning()
        if isinstance(self.settings, DuelSettings):
            eyes = self.sight_observer
            seen = None if eyes is None else eyes.report()
            moves = self.in_physics.first_moves
            return summarise(self.settings, *record, moves, seen)
        if isinstance(self.settings, GameSettings):
            return summarise_game(GameRecord(self.settings, *record))
        walker = self.in_physics.player(WALKER)
        assert isinstance(walker, RobotPlayer)
        return summarise_walk(self.settings, *record, walker, self.solved)


class SolverRecorder(GameObserver):
    """Observer of a walk that collects the results of its MPC."""

    def __init__(self, solved: list[MpcResult]) -> None:
        """Append to a list."""
        self._solved = solved

    def acted(self, game: GameInPlay) -> None:
        """Collect the result of this tick, if there is one."""
        assert isinstance(game.world, PhysicsWorld)
        (walker,) = game.world.players
        assert isinstance(walker, RobotPlayer)
        solved = walker.scheme.walk.balance.solved
        if solved is not None:
            self._solved.append(solved)


def run_duel(settings: DuelSettings, report: Report | None = None) -> DuelRun:
    """Play a duel to its end.

    Args:
        settings: Settings of the duel.
        report: Called about five times a second with the progress. A
            KeyboardInterrupt while playing ends the duel; the part that was
            played is returned.

    Returns:
        The run. Equal settings give equal runs, except for computing times.

    Raises:
        StepAsideError: If the settings contradict each other or cannot be
            met by the robots.
    """
    return cast(DuelRun, _run([settings], report)[0])


def run_duels(settings: Sequence[DuelSettings]) -> list[DuelRun]:
    """Play duels side by side.

    Args:
        settings: Settings of each duel.

    Returns:
        The runs, equal to those of :func:`run_duel`. A KeyboardInterrupt
        ends the duels that still go on.

    Raises:
        StepAsideError: If settings contradict each other or cannot be met by
            the robots.
    """
    return cast(list[DuelRun], _run(settings))


def run_game(settings: GameSettings, report: Report | None = None) -> MatchRun:
    """Play a game at its level to its end; see :func:`run_duel`."""
    return cast(MatchRun, _run([settings], report)[0])


def run_walk(settings: WalkSettings, report: Report | None = None) -> WalkRun:
    """Simulate a walk to its end, or to a fall; see :func:`run_duel`."""
    return cast(WalkRun, _run([settings], report)[0])


def _run(
    settings: Sequence[PlayableSettings], report: Report | None = None
) -> list[GameRun[Any, Any]]:
    """Play games side by side to their ends."""
    games = [RecordedGame(each) for each in settings]
    play(*games, report=report)
    return [game.run() for game in games]
