"""Games that are played from their settings, and become runs."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import inf
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from ..robots.description import RobotDescription
from ..strategies.registry import describe_strategy
from ..strategies.strategy import BodyStrategy, Strategy
from .evaluation import measure
from .floor_games import floor_of, rules_of
from .floor_world import PERIOD, FloorRecorder, FloorWorld
from .forecast import evaluate_duel
from .game import GameInPlay, GameObserver, Outcome, Progress, play
from .game_settings import GameSettings
from .game_starts import with_starts
from .physics_world import PhysicsWorld
from .player_settings import EVADER, WALKER
from .recorder import Recorder
from .run import Run
from .summary import CrowdSummary, PerceptionSummary

if TYPE_CHECKING:
    from .camera_senses import SightEvaluator

Report = Callable[[Progress], None]


class RecordedGame(GameInPlay):
    """Duel, walk or game of players, with its record.

    Attributes:
        settings: Its settings, with nothing left open.
        strategies: Of the players that decide, by name.
        recorder: Recorder of the trajectories.
        sights: Evaluation of the sightings of robots with cameras, by name.
    """

    def __init__(
        self,
        settings: GameSettings,
        observers: Sequence[GameObserver] = (),
        *,
        strategies: Mapping[str, Strategy] = MappingProxyType({}),
        recorded: bool = True,
        closely: bool = False,
        rendered: bool = False,
        endless: bool = False,
        remote: Mapping[str, bool] = MappingProxyType({}),
        description: RobotDescription | None = None,
    ) -> None:
        """Build the world and place the players in it.

        Args:
            settings: Settings of the game.
            observers: Observers in addition to the recorder.
            strategies: Strategies as objects, by name of the player, instead
                of those that the settings name. The settings record their
                classes.
            recorded: Whether to record; the record grows with time.
            closely: Whether to record all signals, as of a walk.
            rendered: Whether to render the world; cameras do so anyway.
            endless: Whether the duration does not end it.
            remote: Whether the true line of sight is measured, by name of
                each robot that other processes command by velocities.
            description: Description of the robot of a walk, if it differs
                from that in its folder.

        Raises:
            StepAsideError: If the settings contradict each other or cannot
                be met by the players.
        """
        described = {
            name: {"strategy": describe_strategy(strategy)}
            for name, strategy in strategies.items()
        }
        settings = with_starts(settings.with_players(described))
        self.settings = settings
        self.sights: Mapping[str, SightEvaluator] = {}
        self.recorder: Recorder | FloorRecorder
        world: PhysicsWorld | FloorWorld
        if settings.level == "physics":
            world = PhysicsWorld(
                settings,
                rendered=rendered,
                remote=remote,
                strategies=strategies,
                descriptions={WALKER: description} if description else {},
            )
            closely = closely or settings.game == "walk"
            self.recorder = Recorder(world, closely=closely)
            self.sights = world.sights(self.recorder.every) if recorded else {}
        else:
            world = floor_of(settings, strategies)
            self.recorder = FloorRecorder(world, PERIOD)
        self.strategies = world.strategies
        kept = (self.recorder, *self.sights.values()) if recorded else ()
        rules = rules_of(settings)
        super().__init__(
            world,
            replace(rules, duration=inf) if endless else rules,
            (*kept, *observers),
        )

    @property
    def in_physics(self) -> PhysicsWorld:
        """The world of a game in physics."""
        assert isinstance(self.world, PhysicsWorld)
        return self.world

    def run(self) -> Run:
        """Return the game as a value; one that goes on is interrupted."""
        settings, tracks = self.settings, self.recorder.tracks()
        for name, seen in self.sights.items():
            tracks[name] = replace(tracks[name], sight=seen.array())
        run = Run(
            name=f"{settings.game}-seed{settings.seed}",
            settings=settings,
            outcome=self.outcome or Outcome.INTERRUPTED,
            message=self.message,
            duration=round(self.world.time, 9),
            times=self.recorder.times,
            tracks=tracks,
        )
        summary, crowds = measure(run), dict[str, CrowdSummary]()
        if run.game == "game" and run.persons:
            from .people import crowds_of

            crowds = crowds_of(run, self)
        notes = [
            f"{name}: {own.assumes}"
            for name, own in self.strategies.items()
            if isinstance(own, BodyStrategy) and own.assumes
        ]
        players = {
            own.name: replace(
                summary.players[own.name],
                goal_at_s=self.goals_at.get(own.name),
                sight=self.sights[own.name].summary()
                if own.name in self.sights
                else None,
                crowd=crowds.get(own.name),
            )
            for own in settings.players
        }
        summary = replace(
            summary,
            real_time_factor=self.real_time_factor,
            touched=list(self.touched),
            fallen=list(self.fallen),
            players=players,
            notes=notes,
            **(self._in_physics(run) if settings.level == "physics" else {}),
            **(
                evaluate_duel(run, self._triggered(run))
                if run.game == "duel"
                else {}
            ),
        )
        return replace(run, summary=summary)

    def _triggered(self, run: Run) -> float | None:
        """Return when the evader of a duel first moved, in [s]."""
        if isinstance(self.world, PhysicsWorld):
            return self.world.first_moves.get(EVADER)
        moved = (run.evader.com != run.evader.com[0]).any(axis=1)
        return float(run.times[moved.argmax() - 1]) if moved.any() else None

    def _in_physics(self, run: Run) -> dict[str, Any]:
        """Return what the summary of a game in physics has beside others."""
        world, recorder = self.in_physics, self.recorder
        assert isinstance(recorder, Recorder)
        found: dict[str, Any] = {"planning": recorder.planning()}
        if self.sights:
            in_view, detected, false = (
                sum(getattr(own, name) for own in self.sights.values())
                for name in ("in_view", "detected", "false")
            )
            rate = detected / in_view if in_view else None
            found["sight"] = PerceptionSummary(world.renderer, rate, false)
        if run.game == "walk":
            from .walk_evaluation import summarise_walk

            walker = world.player(WALKER)
            found["walking"] = summarise_walk(run, walker, recorder.solved)
        return found


def run_game(
    settings: GameSettings,
    report: Report | None = None,
    strategies: Mapping[str, Strategy] = MappingProxyType({}),
) -> Run:
    """Play a game at its level to its end; return its run.

    Equal settings give equal runs, except for computing times. Progress is
    reported about five times a second. A KeyboardInterrupt while playing ends
    the game; the part that was played is returned. Strategies as objects
    replace those of the settings, by name of the player.

    Raises:
        StepAsideError: If the settings contradict each other or cannot be
            met by the players.
    """
    game = RecordedGame(settings, strategies=strategies)
    play(game, report=report)
    return game.run()
