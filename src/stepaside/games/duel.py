"""The game of pursuit and evasion, played in physics (paper, Sec. IV)."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import mujoco

from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..robots.description import RobotDescription, load_robot
from ..robots.jit import prefer_for
from ..sim.body_settings import with_cycle
from ..sim.ground_truth import GroundTruth
from ..sim.ideal_sensors import IdealLineOfSight
from ..sim.obstacle_geoms import add_solids, mover_of
from ..sim.passer_bodies import add_passers, passer_mover
from ..sim.pedestrian_models import FIGURES
from ..sim.person_body import PersonBody, add_person
from ..sim.person_motion import PersonMotion
from ..sim.push import pushes_of
from ..sim.world import World
from ..strategies import Strategy, load_strategy
from .duel_end import ended_duel
from .duel_run import DuelRun
from .duel_settings import EVADER, PLAYERS, PURSUER, DuelSettings
from .initial_poses import frames_of, with_start
from .match import Match, MatchObserver, Progress, play
from .outcome import Outcome
from .person_player import PersonPlayer
from .player import Player
from .recorder import Recorder
from .walker import Walker
from .walker_factory import clearance_in, stand_walker, watch

if TYPE_CHECKING:
    from .camera_duel import CameraSenses, SightObserver


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
        observers: tuple[MatchObserver, ...] = (),
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
        self.settings = settings = with_start(settings)
        self.frames = frames = frames_of(settings)
        setting = _Setting(settings, frames)
        mujoco.mj_forward(setting.world.model, setting.world.data)
        for name, pushes in pushes_of(
            settings.pushes, settings.robots
        ).items():
            if pushes:
                setting.players[PLAYERS.index(name)].push(*pushes)
        tick = setting.world.physics.tick
        self.recorder = Recorder(setting.players, tick=tick)
        self.witness = (
            setting.witness(every=self.recorder.every) if recorded else None
        )
        kept: list[MatchObserver] = [self.recorder]
        if self.witness is not None:
            kept.append(self.witness)
        super().__init__(
            setting.world,
            setting.players,
            (*(kept if recorded else ()), *observers),
            has_things=bool(
                settings.room.things or settings.room.plan or settings.passers
            ),
        )

    def run(self, outcome: Outcome, wall_time: float) -> DuelRun:
        """What was played, as a value.

        Args:
            outcome: How it ended.
            wall_time: Time that it took, in [s].
        """
        return ended_duel(
            self.settings,
            self,
            outcome,
            self.recorder,
            self.witness,
            wall_time,
        )


class _Setting:
    """A world with the players of a duel in it."""

    def __init__(
        self, settings: DuelSettings, frames: tuple[Pose, Pose]
    ) -> None:
        self._settings, self._frames = settings, frames
        walkers = settings.robots
        self._robots = {name: settings.robot_of(name) for name in walkers}
        self._descriptions = {
            name: load_robot(own.robot) for name, own in self._robots.items()
        }
        physics = with_cycle(settings.physics, settings.body)
        self._seeing = _seeing(
            settings, self._descriptions, walkers, physics.tick
        )
        furnish = None if self._seeing is None else self._seeing.furnish
        self.world = World(
            self._descriptions,
            physics,
            settings.body,
            settings.seed,
            furnisher_of(settings, furnish),
        )
        plan = settings.room.plan
        if plan is not None and plan.moving:
            move = mover_of(self.world.model, self.world.data, plan)
            self.world.before_step.append(move)
        if settings.passers:
            walk = passer_mover(
                self.world.model,
                self.world.data,
                settings.passers,
                frames[1],
            )
            walk(0.0)
            self.world.before_step.append(walk)
        person = None
        if PURSUER not in walkers:
            motion = PersonMotion(settings.person, frames[0], frames[1][:2])
            figure = FIGURES[settings.person.figure]
            person = PersonBody(self.world, PURSUER, motion, figure)
        # Each must know the other before it stands: truths come first.
        self._watched = {
            name: watch(self.world, name, description, self._robots[name].gait)
            for name, description in self._descriptions.items()
        }
        self._truths: dict[str, GroundTruth] = {**self._watched}
        if person is not None:
            self._truths[PURSUER] = person.truth
        pursuer: Player = (
            self._walker(PURSUER, settings.pursuer_strategy)
            if person is None
            else PersonPlayer(person, self._truths[EVADER])
        )
        evader = self._walker(EVADER, settings.evader_strategy)
        self.players = (pursuer, evader)

    def _walker(self, name: str, strategy: str | Strategy) -> Walker:
        """Stand a robot, with the senses that the settings give it."""
        settings, seeing = self._settings, self._seeing
        own, description = self._robots[name], self._descriptions[name]
        frame = self._frames[PLAYERS.index(name)]
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
            description,
            frame,
            load_strategy(strategy, settings.strategy),
            gait=own.gait,
            control=own.control,
            body=settings.body,
            seed=settings.seed,
            sight=ideal,
            eyes=None if seeing is None else seeing.eyes(self.world, name),
            perception=None if seeing is None else seeing.perceptions[name],
            truth=self._watched[name],
            clearance=clearance_in(
                settings.room.plan,
                settings.map,
                description,
                own.gait,
                frame,
                None if seeing is None else seeing.perceptions[name],
            ),
        )

    def witness(self, *, every: int) -> "SightObserver | None":
        """Judges of what the robots see, if they see with cameras."""
        if self._seeing is None:
            return None
        from .camera_duel import SightObserver

        judges = {}
        for own, other in (self.players, self.players[::-1]):
            if isinstance(own, Walker):
                judges[own.name] = self._seeing.judge(
                    own.robot,
                    self._truths[other.name],
                    wears_trim=not isinstance(other, PersonPlayer),
                )
        return SightObserver(judges, self._seeing.renderer, every=every)


def furnisher_of(
    settings: DuelSettings,
    furnish: Callable[[mujoco.MjSpec], None] | None = None,
) -> Callable[[mujoco.MjSpec], None] | None:
    """What is put into the world besides the robots, if anything is.

    Args:
        settings: Of the duel.
        furnish: Puts in what the senses need.
    """
    plan, comes = settings.room.plan, settings.pursuer == "person"
    if plan is None and not comes:
        return furnish

    def all_of_it(spec: mujoco.MjSpec) -> None:
        if furnish is not None:
            furnish(spec)
        if plan is not None:
            add_solids(spec, plan)
        if comes:
            add_person(spec, PURSUER, FIGURES[settings.person.figure])
            add_passers(spec, settings.passers)

    return all_of_it


def run_duel(
    settings: DuelSettings,
    report: Callable[[Progress], None] | None = None,
) -> DuelRun:
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
    prefer_for(settings.duration)
    duel = Duel(settings)
    outcome, wall_time = play(duel, settings.duration, report)
    return duel.run(outcome, wall_time)


def _seeing(
    settings: DuelSettings,
    descriptions: Mapping[str, RobotDescription],
    names: tuple[str, ...],
    tick: float,
) -> "CameraSenses | None":
    """Senses of a duel with cameras; an ideal one loads none of it."""
    if settings.sensing != "cameras":
        return None
    from .camera_duel import CameraSenses

    if len({d.folder for d in descriptions.values()}) > 1:
        raise ConfigurationError(
            "sensing must be ideal for different robots, got 'cameras' for "
            f"{', '.join(d.name for d in descriptions.values())}"
        )
    return CameraSenses(settings, descriptions[names[0]], names, tick=tick)
