"""The game of pursuit and evasion, played in physics (paper, Sec. IV)."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import mujoco

from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..robots.description import RobotDescription, load_robot
from ..robots.jit import prefer_for_duration
from ..sim.body_settings import with_control_period
from ..sim.ground_truth import GroundTruth
from ..sim.ideal_sensors import IdealLineOfSight
from ..sim.obstacle_geoms import add_solids, obstacle_mover
from ..sim.passer_bodies import add_passers, passer_mover
from ..sim.pedestrian_models import FIGURES
from ..sim.person_body import PersonBody, add_person
from ..sim.person_motion import PersonMotion
from ..sim.push import pushes_by_robot
from ..sim.world import World
from ..strategies import Strategy, load_strategy
from .duel_evaluation import summarise
from .duel_settings import EVADER, PLAYERS, PURSUER, DuelSettings
from .initial_poses import initial_poses, with_initial_poses
from .match import Match, MatchObserver, Progress, play
from .outcome import Outcome
from .person_player import PersonPlayer
from .player import Player
from .recorder import Recorder
from .run import DuelRun
from .walker import SimulatedPlayer
from .walker_factory import clearance_in, place_walker, watch

if TYPE_CHECKING:
    from .camera_duel import CameraSenses, SightObserver


class Duel(Match):
    """Match of one pursuer and one evader.

    Attributes:
        settings: Settings of the duel, with the initial poses filled in.
        frames: Initial poses of pursuer and evader in the world.
        recorder: Recorder of the trajectories.
        witness: Evaluation of the perception, if sensing is by cameras.
    """

    def __init__(
        self,
        settings: DuelSettings,
        observers: tuple[MatchObserver, ...] = (),
        *,
        recorded: bool = True,
        rendered: bool = False,
    ) -> None:
        """Build the world and place the players in it.

        Args:
            settings: Settings of the duel.
            observers: Observers in addition to the recorder.
            recorded: Whether to record; the record grows with time.
            rendered: Whether to render the world of the duel; cameras do so
                in any case.

        Raises:
            StepAsideError: If the settings contradict each other or cannot
                be met by the robots.
        """
        self.settings = settings = with_initial_poses(settings)
        self.frames = frames = initial_poses(settings)
        stage = _Stage(settings, frames, rendered=rendered)
        mujoco.mj_forward(stage.world.model, stage.world.data)
        for name, pushes in pushes_by_robot(
            settings.pushes, settings.robots
        ).items():
            if pushes:
                stage.players[PLAYERS.index(name)].push(*pushes)
        tick = stage.world.physics.tick
        self.recorder = Recorder(stage.players, tick=tick)
        self.witness = (
            stage.witness(every=self.recorder.every) if recorded else None
        )
        recorders: list[MatchObserver] = [self.recorder]
        if self.witness is not None:
            recorders.append(self.witness)
        super().__init__(
            stage.world,
            stage.players,
            (*(recorders if recorded else ()), *observers),
            has_things=bool(
                settings.room.things or settings.room.plan or settings.passers
            ),
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
            self.witness,
            wall_time,
        )


class _Stage:
    """World of a duel with its players."""

    def __init__(
        self,
        settings: DuelSettings,
        frames: tuple[Pose, Pose],
        *,
        rendered: bool,
    ) -> None:
        self._settings, self._frames = settings, frames
        walkers = settings.robots
        self._robots = {name: settings.robot_of(name) for name in walkers}
        self._descriptions = {
            name: load_robot(own.robot) for name, own in self._robots.items()
        }
        physics = with_control_period(settings.physics, settings.body)
        self._senses = _camera_senses(
            settings, self._descriptions, walkers, physics.tick
        )
        furnish = None if self._senses is None else self._senses.furnish
        self.world = World(
            self._descriptions,
            physics,
            settings.body,
            settings.seed,
            furnisher_of(settings, furnish),
            rendered=rendered or self._senses is not None,
        )
        plan = settings.room.plan
        if plan is not None and plan.moving:
            move = obstacle_mover(self.world.model, self.world.data, plan)
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
        # A player's ideal sensor needs the true state of its opponent.
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

    def _walker(self, name: str, strategy: str | Strategy) -> SimulatedPlayer:
        """Place a robot in the world, with the sensors of the settings."""
        settings, senses = self._settings, self._senses
        own, description = self._robots[name], self._descriptions[name]
        frame = self._frames[PLAYERS.index(name)]
        ideal = None
        if senses is None:
            other = PURSUER if name == EVADER else EVADER
            ideal = IdealLineOfSight(
                self._truths[name],
                self._truths[other],
                settings.sight,
                named_generator(settings.seed, f"sight/{name}"),
            )
        return place_walker(
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
            eyes=None if senses is None else senses.eyes(self.world, name),
            perception=None if senses is None else senses.perceptions[name],
            truth=self._watched[name],
            clearance=clearance_in(
                settings.room.plan,
                settings.map,
                description,
                own.gait,
                frame,
                None if senses is None else senses.perceptions[name],
            ),
        )

    def witness(self, *, every: int) -> "SightObserver | None":
        """Return the evaluation of perception, if sensing is by cameras."""
        if self._senses is None:
            return None
        from .camera_duel import SightObserver

        judges = {}
        for own, other in (self.players, self.players[::-1]):
            if isinstance(own, SimulatedPlayer):
                judges[own.name] = self._senses.judge(
                    own.robot,
                    self._truths[other.name],
                    wears_trim=not isinstance(other, PersonPlayer),
                )
        return SightObserver(judges, self._senses.renderer, every=every)


def furnisher_of(
    settings: DuelSettings,
    furnish: Callable[[mujoco.MjSpec], None] | None = None,
) -> Callable[[mujoco.MjSpec], None] | None:
    """Return the function that adds everything but robots to the world.

    Args:
        settings: Settings of the duel.
        furnish: Adds walls, objects and sensors for camera sensing.

    Returns:
        The function; None if there is nothing to add.
    """
    plan, has_person = settings.room.plan, settings.pursuer == "person"
    if plan is None and not has_person:
        return furnish

    def furnish_all(spec: mujoco.MjSpec) -> None:
        if furnish is not None:
            furnish(spec)
        if plan is not None:
            add_solids(spec, plan)
        if has_person:
            add_person(spec, PURSUER, FIGURES[settings.person.figure])
            add_passers(spec, settings.passers)

    return furnish_all


def make_duel_run(
    settings: DuelSettings,
    match: Match,
    outcome: Outcome,
    recorder: Recorder,
    witness: "SightObserver | None",
    wall_time: float,
) -> DuelRun:
    """Return a finished duel as a value.

    Args:
        settings: Settings of the duel, with the initial poses filled in.
        match: The match that was played.
        outcome: How it ended.
        recorder: Recorder of the trajectories.
        witness: Evaluation of the perception, if sensing is by cameras.
        wall_time: Time that the computation took, in [s].
    """
    tracks, times = recorder.tracks(), recorder.times
    if witness is not None:
        for name, rows in witness.sight().items():
            tracks[name] = replace(tracks[name], sight=rows)
    summary = summarise(
        settings,
        match,
        times,
        tracks,
        recorder.planning(),
        None if witness is None else witness.figures(),
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
        stills={} if witness is None else witness.stills(),
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
    prefer_for_duration(settings.duration)
    duel = Duel(settings)
    outcome, wall_time = play(duel, settings.duration, report)
    return duel.run(outcome, wall_time)


def _camera_senses(
    settings: DuelSettings,
    descriptions: Mapping[str, RobotDescription],
    names: tuple[str, ...],
    tick: float,
) -> "CameraSenses | None":
    """Return the camera sensing of a duel; None with ideal sight."""
    if settings.sensing != "cameras":
        return None
    from .camera_duel import CameraSenses

    if len({d.folder for d in descriptions.values()}) > 1:
        raise ConfigurationError(
            "sensing must be ideal for different robots, got 'cameras' for "
            f"{', '.join(d.name for d in descriptions.values())}"
        )
    return CameraSenses(settings, descriptions[names[0]], names, tick=tick)
