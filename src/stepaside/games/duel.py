"""The game of pursuit and evasion, played in physics (paper, Sec. IV)."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from ..locomotion.policy.network_pool import NetworkPool
from .duel_as_game import build_duel_world
from .duel_evaluation import summarise
from .duel_settings import DuelSettings
from .game import Progress
from .initial_poses import initial_poses, with_initial_poses
from .match import MatchObserver, play, play_together
from .outcome import Outcome
from .pair_match import PairMatch
from .recorder import Recorder
from .run import DuelRun

if TYPE_CHECKING:
    from .camera_senses import SightObserver


class Duel(PairMatch):
    """Match of one pursuer and one evader.

    Attributes:
        settings: Settings of the duel, with the initial poses filled in.
        frames: Initial poses of pursuer and evader in the world.
        recorder: Recorder of the trajectories.
        sight_observer: Evaluation of the perception, if sensing is by cameras.
    """

    def __init__(
        self,
        settings: DuelSettings,
        observers: tuple[MatchObserver, ...] = (),
        *,
        recorded: bool = True,
        rendered: bool = False,
        networks: NetworkPool | None = None,
    ) -> None:
        """Build the world and place the players in it.

        Args:
            settings: Settings of the duel.
            observers: Observers in addition to the recorder.
            recorded: Whether to record; the record grows with time.
            rendered: Whether to render the world of the duel; cameras do so
                in any case.
            networks: Networks of robots on learned legs, shared with other
                duels.

        Raises:
            StepAsideError: If the settings contradict each other or cannot
                be met by the robots.
        """
        self.settings = settings = with_initial_poses(settings)
        self.frames = initial_poses(settings)
        stage = build_duel_world(
            settings, rendered=rendered, networks=networks
        )
        tick = stage.world.physics.tick
        self.recorder = Recorder(stage.players, tick=tick)
        self.sight_observer = None
        if recorded:
            every = self.recorder.every
            self.sight_observer = stage.sight_observer(
                settings.room.things, every=every
            )
        recorders: list[MatchObserver] = [self.recorder]
        if self.sight_observer is not None:
            recorders.append(self.sight_observer)
        super().__init__(
            stage.world,
            stage.players,
            (*(recorders if recorded else ()), *observers),
            has_things=settings.has_things,
            networks=stage.networks,
        )

    def run(self, outcome: Outcome, wall_time: float) -> DuelRun:
        """Return the finished duel as a value.

        Args:
            outcome: How it ended.
            wall_time: Time that the computation took, in [s].
        """
        return make_duel_run(
            self.settings,
            self,
            outcome,
            self.recorder,
            self.sight_observer,
            wall_time,
        )


def make_duel_run(
    settings: DuelSettings,
    match: PairMatch,
    outcome: Outcome,
    recorder: Recorder,
    sight_observer: "SightObserver | None",
    wall_time: float,
) -> DuelRun:
    """Return a finished duel as a value.

    Args:
        settings: Settings of the duel, with the initial poses filled in.
        match: The match that was played.
        outcome: How it ended.
        recorder: Recorder of the trajectories.
        sight_observer: Evaluation of the perception, if sensing is by cameras.
        wall_time: Time that the computation took, in [s].
    """
    tracks, times = recorder.tracks(), recorder.times
    if sight_observer is not None:
        for name, rows in sight_observer.sight().items():
            tracks[name] = replace(tracks[name], sight=rows)
    summary = summarise(
        settings,
        match,
        times,
        tracks,
        recorder.planning(),
        None if sight_observer is None else sight_observer.report(),
        wall_time,
    )
    return DuelRun(
        name=f"duel-seed{settings.seed}",
        settings=settings,
        outcome=outcome,
        message=match.message,
        duration=round(match.world.time, 9),
        times=times,
        tracks=tracks,
        summary=summary,
        stills={} if sight_observer is None else sight_observer.stills(),
    )


def run_duel(
    settings: DuelSettings,
    report: Callable[[Progress], None] | None = None,
) -> DuelRun:
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
    duel = Duel(settings)
    outcome, wall_time = play(duel, settings.duration, report)
    return duel.run(outcome, wall_time)


def run_duels(settings: Sequence[DuelSettings]) -> list[DuelRun]:
    """Play duels side by side; networks are evaluated for all at once.

    Args:
        settings: Settings of each duel.

    Returns:
        The runs, equal to those of :func:`run_duel`. A KeyboardInterrupt
        ends the duels that still go on.

    Raises:
        StepAsideError: If settings contradict each other or cannot be met by
            the robots.
    """
    networks = NetworkPool()
    duels = [Duel(each, networks=networks) for each in settings]
    ended = play_together(duels, [each.duration for each in settings])
    return [
        duel.run(*result) for duel, result in zip(duels, ended, strict=True)
    ]
