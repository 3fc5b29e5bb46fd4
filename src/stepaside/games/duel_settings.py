"""Settings of a duel: equal settings repeat it exactly."""

from dataclasses import dataclass, field, fields, replace
from math import pi
from typing import ClassVar

from ..control.clearance.map_settings import MapSettings
from ..core.brief_repr import brief_repr
from ..core.errors import ConfigurationError, check_within
from ..core.ranges import (
    RUNTIME,
    SEEDS,
    Range,
    Ranges,
    check_count,
    check_settings,
)
from ..locomotion.zmp.control_settings import ControlSettings
from ..planning import GaitSettings
from ..sim.body_settings import BodySettings
from ..sim.camera_settings import CameraSettings, SceneSettings
from ..sim.passerby_settings import MOST_PASSERS, Passer
from ..sim.person_settings import PersonSettings, check_pursuer
from ..sim.physics_settings import PhysicsSettings, SightSettings
from ..sim.push import MOST_PUSHES, Push, check_pushes
from ..strategies import Evasion, Strategy
from ..strategies.registry import (
    OF_EVASION,
    check_strategy_name,
    describe_strategy,
    is_described,
)
from .strategy_objects import EVASION, resolve_strategies

ERROR = ConfigurationError
SENSING = ("ideal", "cameras")
PLAYERS = PURSUER, EVADER = ("pursuer", "evader")
PURSUIT = "pursuit"  # of the paper, like EVASION


@dataclass(frozen=True, slots=True)
class StartSettings:
    """Initial poses of the players; omitted values are drawn from the seed.

    Attributes:
        distance: Distance between the reference points of the players, in
            [m]; drawn between ``near`` and ``far``; 0 to 100 or none.
        pursuer_offset: Heading of the pursuer relative to the line of sight
            to the evader, in [rad]; drawn from -90 deg to 90 deg; -3.14159 to
            3.14159 or none.
        evader_offset: Heading of the evader relative to the line of sight to
            the pursuer, in [rad]; drawn from -30 deg to 30 deg; -3.14159 to
            3.14159 or none.
        least: Smallest distance at which the robots cannot overlap, in [m]; 0
            to 100.
        near: Smallest distance that is drawn, in [m]; 0 to 100.
        far: Greatest distance that is drawn, in [m]; 0 to 100.
    """

    distance: float | None = None
    pursuer_offset: float | None = None
    evader_offset: float | None = None
    least: float = 0.4
    near: float = 0.6
    far: float = 1.5

    ranges: ClassVar[Ranges] = {
        "distance": Range(
            0.0,
            100.0,
            "m",
            "at ``least``, or they touch; farther, they never meet",
            also=(None,),
        ),
        "pursuer_offset": Range(-pi, pi, "rad", "half a turn", also=(None,)),
        "evader_offset": Range(-pi, pi, "rad", "half a turn", also=(None,)),
        "least": Range(0.0, 100.0, "m", "beyond, they never meet"),
        "near": Range(0.0, 100.0, "m", "between ``least`` and ``far``"),
        "far": Range(0.0, 100.0, "m", "beyond, they never meet"),
    }

    def __post_init__(self) -> None:
        """Validate ranges and the order of the distances."""
        check_settings(self)
        check_within(self.far, self.least, 100.0, "far", "m", ERROR)
        check_within(self.near, self.least, self.far, "near", "m", ERROR)
        if self.distance is not None:
            low = self.least
            check_within(self.distance, low, 100.0, "distance", "m", ERROR)


@dataclass(frozen=True, slots=True)
class RobotSettings:
    """Robot of a player, with its gait and control.

    Attributes:
        robot: Name of a robot or folder of its description.
        gait: Gait settings.
        control: Control settings.
    """

    robot: str = "nao"
    gait: GaitSettings = field(default_factory=GaitSettings)
    control: ControlSettings = field(default_factory=ControlSettings)


@dataclass(frozen=True, slots=True)
class DuelSettings:
    """Settings of a duel.

    Attributes:
        seed: Seed of every random draw; 0 to 3.40282e+38.
        duration: Simulated time, in [s]; 0.001 to 86400.
        robot: Name of a robot or folder of its description.
        pursuer_robot: Robot, gait and control of the pursuer, if it differs
            from ``robot``.
        evader_robot: Robot, gait and control of the evader, likewise.
        start: Initial poses.
        strategy: Settings of the evasion strategy of the paper.
        evader_strategy: Strategy of the evader: "evasion" for that of the
            paper, another name of :data:`~stepaside.strategies.STRATEGIES`, or
            FILE.py:NAME; from Python also a strategy object.
        pursuer_strategy: Strategy of a pursuing robot, likewise.
        gait: Gait of both players, except for one with its own robot.
        sight: Errors of the ideal line of sight.
        physics: Physics, floor and clock.
        body: Deviations of the bodies from ideal ones.
        control: Control of both players, except for one with its own robot.
        sensing: "ideal" for the line of sight of ``sight``, or "cameras".
        cameras: Cameras and their renderer, with camera sensing.
        room: Walls, objects and room of the game.
        map: Knowledge of the room that the game is played in.
        pursuer: "robot", or "person".
        person: Motion of a person as pursuer.
        pushes: Pushes on the robots.
        passers: Further people who walk past, with a person as pursuer; ideal
            sight reports only the pursuer to the evader.
    """

    __repr__ = brief_repr

    seed: int = 1
    duration: float = 120.0
    robot: str = "nao"
    start: StartSettings = field(default_factory=StartSettings)
    strategy: Evasion = field(default_factory=Evasion)
    evader_strategy: str | Strategy = EVASION
    pursuer_strategy: str | Strategy = PURSUIT
    gait: GaitSettings = field(default_factory=GaitSettings)
    sight: SightSettings = field(default_factory=SightSettings)
    physics: PhysicsSettings = field(default_factory=PhysicsSettings)
    body: BodySettings = field(default_factory=BodySettings)
    control: ControlSettings = field(default_factory=ControlSettings)
    sensing: str = "ideal"
    cameras: CameraSettings = field(default_factory=CameraSettings)
    room: SceneSettings = field(default_factory=SceneSettings)
    map: MapSettings = field(default_factory=MapSettings)
    pursuer: str = "robot"
    person: PersonSettings = field(default_factory=PersonSettings)
    pursuer_robot: RobotSettings | None = None
    evader_robot: RobotSettings | None = None
    pushes: tuple[Push, ...] = ()
    passers: tuple[Passer, ...] = ()

    ranges: ClassVar[Ranges] = {"seed": SEEDS, "duration": RUNTIME}

    def __post_init__(self) -> None:
        """Validate ranges, strategies and combinations of settings."""
        for name, value in resolve_strategies(
            self.strategy, self.evader_strategy, self.pursuer_strategy
        ).items():
            object.__setattr__(self, name, value)
        if not (
            isinstance(self.evader_strategy, str)
            and isinstance(self.pursuer_strategy, str)
        ):
            self.named()  # validates the copy that holds names
            return
        check_settings(self)
        check_pursuer(self.pursuer)
        for name in ("evader_strategy", "pursuer_strategy"):
            check_strategy_name(getattr(self, name), name, recorded=True)
        if self.pursuer == "person" and self.pursuer_strategy != PURSUIT:
            raise ConfigurationError(
                f"pursuer_strategy must be {PURSUIT!r} for a person, whose "
                f"path is person.path, got {self.pursuer_strategy!r}"
            )
        if self.pursuer == "person" and self.room.plan is not None:
            raise ConfigurationError(
                "room.plan must be omitted with a person as pursuer: people "
                "walk on an open floor"
            )
        if self.room.plan is not None and self.map.source == "seen":
            if self.sensing != "cameras":
                raise ConfigurationError(
                    "sensing must be 'cameras' with map.source = 'seen', "
                    f"got {self.sensing!r}"
                )
        if self.sensing not in SENSING:
            raise ConfigurationError(
                f"sensing must be one of {', '.join(SENSING)}, "
                f"got {self.sensing!r}"
            )
        check_count(self.pushes, MOST_PUSHES, "pushes")
        check_pushes(self.pushes, self.robots)
        check_count(self.passers, MOST_PASSERS, "passers")
        if self.passers and self.pursuer != "person":
            raise ConfigurationError(
                "passers need a person as pursuer, got pursuer "
                f"{self.pursuer!r}"
            )

    def robot_of(self, player: str) -> RobotSettings:
        """Return robot, gait and control of a player.

        Args:
            player: "pursuer" or "evader".
        """
        own = self.pursuer_robot if player == PURSUER else self.evader_robot
        return own or RobotSettings(self.robot, self.gait, self.control)

    def named(self) -> "DuelSettings":
        """Return the settings with a text for each strategy object."""
        return replace(
            self,
            evader_strategy=describe_strategy(self.evader_strategy),
            pursuer_strategy=describe_strategy(self.pursuer_strategy),
        )

    @property
    def uses_evasion(self) -> bool:
        """Whether a player uses the settings of ``strategy``."""
        played = (self.evader_strategy, self.pursuer_strategy)
        return any(
            each in OF_EVASION
            if isinstance(each, str)
            else isinstance(each, Evasion)
            for each in played
        )

    @property
    def notes(self) -> tuple[str, ...]:
        """Remarks on the run for its readers, one sentence each."""
        named = self.named()
        found = []
        for name in ("evader_strategy", "pursuer_strategy"):
            text = getattr(named, name)
            if is_described(text):
                found.append(
                    f"{name} is a Python object: the configuration of this "
                    f"run does not repeat it ({text})"
                )
        usual = Evasion()
        unused = [
            f"strategy.{each.name}"
            for each in fields(usual)
            if getattr(self.strategy, each.name) != getattr(usual, each.name)
        ]
        if unused and not self.uses_evasion:
            found.append(
                f"without effect: {', '.join(unused)}, as no player uses "
                f"them (evader_strategy {named.evader_strategy})"
            )
        return tuple(found)

    @property
    def cycle(self) -> float:
        """Duration of a gait cycle, two steps of the slower robot, in [s]."""
        robots = [self.robot_of(player) for player in PLAYERS]
        return 2.0 * max(own.gait.step_duration for own in robots)

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the players that are robots."""
        return PLAYERS if self.pursuer == "robot" else (EVADER,)

    @property
    def both(self) -> str:
        """Both players, as text: "both robots" or "both players"."""
        return "both robots" if self.pursuer == "robot" else "both players"

    @property
    def is_of_the_paper(self) -> bool:
        """Whether both strategies are those of the paper, without a room."""
        played = (self.evader_strategy, self.pursuer_strategy)
        return self.room.plan is None and played == (EVASION, PURSUIT)
