"""The game of pursuit and evasion, played in physics (paper, Sec. IV)."""

from collections.abc import Callable
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

import mujoco

from ..poses import Pose
from ..randomness import named_generator
from ..robots.description import RobotDescription, load_robot
from ..strategies import load_strategy
from ..world.body_settings import with_cycle
from ..world.person import Person, add_person
from ..world.person_motion import Motion
from ..world.sight import IdealLineOfSight
from ..world.truth import TrueState
from ..world.world import World
from .match import Match, Observer, Progress, play
from .outcome import Outcome
from .pedestrian import Pedestrian
from .player import Player
from .record import Recorder
from .run import Run
from .settings import EVADER, PLAYERS, PURSUER, DuelSettings
from .standing import stand_walker
from .start import draw_start
from .summary import summarise
from .walker import Walker

if TYPE_CHECKING:
    from .seeing import Seeing, Witness


class Duel(Match):
    """A pursuer and an evader, ready to play.

    Attributes:
        settings: What decides the duel, with the start that was drawn.
        frames: Where pursuer and evader stand at first.
        recorder: What keeps the record, if one is kept.
        witness: Who judges what they see, if they see with cameras.
    """

    def __init__(
        self,
        settings: DuelSettings,
        observers: tuple[Observer, ...] = (),
        *,
        recorded: bool = True,
    ) -> None:
        """Build the world and stand the players in it.

        Args:
            settings: What decides the duel.
            observers: Who looks on besides the recorder.
            recorded: Whether a record is kept, which grows with time.

        Raises:
            StepAsideError: If the settings ask for what cannot be.
        """
        self.settings = settings = replace(
            settings, start=draw_start(settings)
        )
        self.frames = frames = _frames(settings)
        setting = _Setting(settings, frames)
        mujoco.mj_forward(setting.world.model, setting.world.data)
        tick = setting.world.physics.tick
        self.recorder = Recorder(setting.players, tick=tick)
        self.witness = (
            setting.witness(every=self.recorder.every) if recorded else None
        )
        kept: list[Observer] = [self.recorder]
        if self.witness is not None:
            kept.append(self.witness)
        super().__init__(
            setting.world,
            setting.players,
            (*(kept if recorded else ()), *observers),
            has_things=bool(settings.room.things),
        )

    def run(self, outcome: Outcome, wall_time: float) -> Run:
        """What was played, as a value.

        Args:
            outcome: How it ended.
            wall_time: Time that it took, in [s].
        """
        tracks = self.recorder.tracks()
        witness = self.witness
        if witness is not None:
            for name, rows in witness.sight().items():
                tracks[name] = replace(tracks[name], sight=rows)
        times = self.recorder.times
        summary = summarise(
            self.settings,
            self,
            outcome,
            times,
            tracks,
            self.recorder.planning(),
            {} if witness is None else witness.figures(),
            wall_time,
        )
        return Run(
            name=f"duel-seed{self.settings.seed}",
            settings=self.settings,
            outcome=outcome,
            message=self.message,
            duration=summary.duration_s,
            times=times,
            tracks=tracks,
            summary=summary,
            stills={} if witness is None else witness.stills(),
        )


class _Setting:
    """A world with the players of a duel in it."""

    def __init__(
        self, settings: DuelSettings, frames: tuple[Pose, Pose]
    ) -> None:
        self._settings, self._frames = settings, frames
        walkers = walkers_of(settings)
        self._description = load_robot(settings.robot)
        physics = with_cycle(settings.physics, settings.body)
        self._seeing = _seeing(
            settings, self._description, walkers, physics.tick
        )
        furnish = None if self._seeing is None else self._seeing.furnish
        self.world = World(
            dict.fromkeys(walkers, self._description),
            physics,
            settings.body,
            settings.seed,
            furnisher_of(settings, furnish),
        )
        person = None
        if PURSUER not in walkers:
            motion = Motion(settings.person, frames[0], frames[1][:2])
            person = Person(self.world, PURSUER, motion)
        self._truths = {
            name: TrueState(
                self.world.model,
                self.world.data,
                f"{name}/{self._description.torso}",
                com_forward=settings.gait.zmp_forward,
            )
            for name in walkers
        }
        if person is not None:
            self._truths[PURSUER] = person.truth
        pursuer: Player = (
            self._walker(PURSUER, settings.pursuer_strategy)
            if person is None
            else Pedestrian(person, self._truths[EVADER])
        )
        evader = self._walker(EVADER, settings.evader_strategy)
        self.players = (pursuer, evader)

    def _walker(self, name: str, strategy: str) -> Walker:
        """Stand a robot, with the senses that the settings give it."""
        settings, seeing = self._settings, self._seeing
        ideal = None
        if seeing is None:
            other = PURSUER if name == EVADER else EVADER
            ideal = IdealLineOfSight(
                self._truths[name],
                self._truths[other],
                settings.sight,
                named_generator(settings.seed, f"sight/{name}"),
            )
        return stand_walker(
            self.world,
            name,
            self._description,
            self._frames[PLAYERS.index(name)],
            load_strategy(strategy, settings.strategy),
            gait=settings.gait,
            control=settings.control,
            body=settings.body,
            seed=settings.seed,
            sight=ideal,
            eyes=None if seeing is None else seeing.eyes(self.world, name),
            perception=None if seeing is None else seeing.perceptions[name],
        )

    def witness(self, *, every: int) -> "Witness | None":
        """Judges of what the robots see, if they see with cameras."""
        if self._seeing is None:
            return None
        from .seeing import Witness

        judges = {}
        for own, other in (self.players, self.players[::-1]):
            if isinstance(own, Walker):
                judges[own.name] = self._seeing.judge(
                    own.robot,
                    self._truths[other.name],
                    wears_trim=not isinstance(other, Pedestrian),
                )
        return Witness(judges, self._seeing.renderer, every=every)


def walkers_of(settings: DuelSettings) -> tuple[str, ...]:
    """Names of those that are robots."""
    return PLAYERS if settings.pursuer == "robot" else (EVADER,)


def furnisher_of(
    settings: DuelSettings,
    furnish: Callable[[mujoco.MjSpec], None] | None = None,
) -> Callable[[mujoco.MjSpec], None] | None:
    """What is put into the world besides the robots, if anything is.

    Args:
        settings: Of the duel.
        furnish: Puts in what the senses need.
    """
    if settings.pursuer == "robot":
        return furnish

    def both(spec: mujoco.MjSpec) -> None:
        if furnish is not None:
            furnish(spec)
        add_person(spec, PURSUER)

    return both


def run_duel(
    settings: DuelSettings,
    report: Callable[[Progress], None] | None = None,
) -> Run:
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
    outcome, wall_time = play(duel, settings.duration, report)
    return duel.run(outcome, wall_time)


def _frames(settings: DuelSettings) -> tuple[Pose, Pose]:
    """Where pursuer and evader stand at first."""
    start = settings.start
    assert start.distance is not None
    assert start.pursuer_offset is not None
    assert start.evader_offset is not None
    return (
        Pose(0.0, 0.0, start.pursuer_offset),
        Pose(start.distance, 0.0, pi + start.evader_offset),
    )


def _seeing(
    settings: DuelSettings,
    description: RobotDescription,
    names: tuple[str, ...],
    tick: float,
) -> "Seeing | None":
    """Senses of a duel with cameras; an ideal one loads none of it."""
    if settings.sensing != "cameras":
        return None
    from .seeing import Seeing

    return Seeing(settings, description, names, tick=tick)
