"""Settings of a duel: equal settings repeat it exactly."""

from dataclasses import dataclass, fields, replace
from math import pi
from typing import ClassVar

from ..core.brief_repr import brief_repr
from ..core.errors import ConfigurationError, check_within
from ..core.ranges import (
    RUNTIME,
    SEEDS,
    Range,
    check_count,
)
from ..core.setting import check_settings, setting
from ..locomotion.control_settings import (
    ControlSettings,
    LegsSettings,
    MapSettings,
)
from ..planning import PRESETS, GaitSettings
from ..sim.body_settings import BODIES, BodySettings
from ..sim.camera_settings import (
    CameraSettings,
    LidarSettings,
    SceneSettings,
)
from ..sim.person_settings import PURSUERS, PersonSettings
from ..sim.physics_settings import PhysicsSettings, SightSettings
from ..sim.push import MOST_PUSHES, Push, check_pushes
from ..strategies import Evasion, Strategy, load_strategy
from ..strategies.registry import (
    OF_EVASION,
    STRATEGIES,
    check_strategy_name,
    describe_strategy,
    is_described,
)
from ..strategies.shield import shielded
from ..strategies.shield_settings import ShieldSettings
from .implied_settings import (
    EVASION,
    implied_control,
    implied_evader,
    implied_trigger,
)
from .strategy_resolution import resolve_strategies

ERROR = ConfigurationError
SENSING = ("ideal", "cameras", "lidar")
PLAYERS = PURSUER, EVADER = ("pursuer", "evader")
PURSUIT = "pursuit"  # of the paper, like EVASION
STRATEGY_NAMES = (
    f"{', '.join(STRATEGIES)}, with arguments like pursuit(gain=2), "
    "FILE.py:NAME for your own, or FILE.onnx for a learned one"
)


@dataclass(frozen=True, slots=True)
class StartSettings:
    """Initial poses of the players; omitted values are drawn from the seed."""

    distance: float | None = setting(
        None,
        "Initial distance between the reference points of the players",
        Range(
            0.0,
            100.0,
            "m",
            "at ``least``, or they touch; farther, they never meet",
            also=(None,),
        ),
        words={"drawn": None},
    )
    pursuer_offset: float | None = setting(
        None,
        "Heading of the pursuer relative to its line of sight to the evader "
        "{unit}, drawn up to a right angle to either side",
        Range(-pi, pi, "rad", "half a turn", also=(None,)),
        words={"drawn": None},
    )
    evader_offset: float | None = setting(
        None,
        "Heading of the evader relative to its line of sight to the pursuer "
        "{unit}, drawn up to 30 degrees to either side",
        Range(-pi, pi, "rad", "half a turn", also=(None,)),
        words={"drawn": None},
    )
    least: float = setting(
        0.4,
        "Smallest distance at which the robots cannot overlap",
        Range(0.0, 100.0, "m", "beyond, they never meet"),
    )
    near: float = setting(
        0.6,
        "Smallest initial distance that is drawn",
        Range(0.0, 100.0, "m", "between ``least`` and ``far``"),
    )
    far: float = setting(
        1.5,
        "Greatest initial distance that is drawn",
        Range(0.0, 100.0, "m", "beyond, they never meet"),
    )

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
    """Robot of a player, with its gait and control."""

    robot: str = setting(
        "nao", "Name of a robot, or folder of its description"
    )
    gait: GaitSettings = setting(GaitSettings(), "Gait")
    control: ControlSettings = setting(ControlSettings(), "Walking control")
    legs: LegsSettings = setting(LegsSettings(), "Learned legs")

    def resolved(self, body: BodySettings) -> "RobotSettings":
        """Return the robot with its control as gait and body need."""
        control = implied_control(self.control, self.gait, body)
        return replace(self, control=control)


@dataclass(frozen=True, slots=True)
class DuelSettings:
    """Settings of a duel."""

    game: ClassVar[str] = "duel"
    __repr__ = brief_repr

    seed: int = setting(
        1,
        "Random seed",
        SEEDS,
    )
    duration: float = setting(
        120.0,
        "Simulated time",
        RUNTIME,
    )
    robot: str = setting(
        "nao",
        "Name of a robot, or folder of its description",
    )
    start: StartSettings = setting(StartSettings(), "Initial poses")
    strategy: Evasion = setting(
        Evasion(), "Settings of the paper's evasion strategy"
    )
    evader_strategy: str | Strategy = setting(
        "",
        f"Strategy of the evader: {STRATEGY_NAMES}",
        default_text="evasion; step-aside on learned legs against a person",
    )
    pursuer_strategy: str | Strategy = setting(
        PURSUIT,
        f"Strategy of a robot pursuer: {STRATEGY_NAMES}",
        default_text="pursuit",
    )
    shield: ShieldSettings = setting(
        ShieldSettings(), "Shield of the evader", needs=("shield.enabled", "")
    )
    gait: GaitSettings = setting(
        GaitSettings(),
        "Gait of each player without a robot of its own",
        presets=PRESETS,
    )
    sight: SightSettings = setting(
        SightSettings(), "Errors of ideal sensing", needs=("sensing", "ideal")
    )
    physics: PhysicsSettings = setting(
        PhysicsSettings(), "Physics, floor and clock"
    )
    body: BodySettings = setting(
        BodySettings(),
        "Deviations of the bodies from ideal ones",
        presets=BODIES,
    )
    control: ControlSettings = setting(
        ControlSettings(),
        "Walking control of each player without a robot of its own",
    )
    legs: LegsSettings = setting(
        LegsSettings(),
        "Learned legs of each player without a robot of its own",
    )
    sensing: str = setting(
        "ideal",
        "Sensing of opponents: true poses (ideal), or detection in simulated "
        "camera images, or of people in the scans of a simulated lidar",
        names=SENSING,
    )
    cameras: CameraSettings = setting(
        CameraSettings(),
        "Cameras, with camera sensing",
        needs=("sensing", "cameras"),
    )
    lidar: LidarSettings = setting(
        LidarSettings(),
        "Lidar, with lidar sensing",
        needs=("sensing", "lidar"),
    )
    room: SceneSettings = setting(
        SceneSettings(), "Room, and what the cameras see of it"
    )
    map: MapSettings = setting(
        MapSettings(),
        "Map of the room that robots have",
        needs=("room.plan", ""),
    )
    pursuer: str = setting(
        "robot",
        "Kind of pursuer",
        names=PURSUERS,
    )
    person: PersonSettings = setting(
        PersonSettings(),
        "Motion of a person as pursuer",
        needs=("pursuer", "person"),
    )
    pursuer_robot: RobotSettings | None = setting(
        None,
        "Robot, gait and control of the pursuer, if it has a robot of its own",
    )
    evader_robot: RobotSettings | None = setting(
        None,
        "Robot, gait and control of the evader, if it has a robot of its own",
    )
    pushes: tuple[Push, ...] = setting(
        (),
        "Pushes on the robots",
    )

    def __post_init__(self) -> None:
        """Validate ranges, strategies and combinations of settings."""
        resolved = resolve_strategies(
            self.strategy, self.evader_strategy, self.pursuer_strategy
        )
        for name, value in resolved._asdict().items():
            object.__setattr__(self, name, value)
        if not (
            isinstance(self.evader_strategy, str)
            and isinstance(self.pursuer_strategy, str)
        ):
            self.named()  # validates the copy that holds names
            return
        check_settings(self)
        for name in ("evader_strategy", "pursuer_strategy"):
            if name == "pursuer_strategy" or self.evader_strategy:
                check_strategy_name(getattr(self, name), name, recorded=True)
        if self.pursuer == "person" and self.pursuer_strategy != PURSUIT:
            raise ConfigurationError(
                f"pursuer_strategy must be {PURSUIT!r} for a person, whose "
                f"path is person.path, got {self.pursuer_strategy!r}"
            )
        maps = self.room.plan is not None and self.map.source == "seen"
        if maps and self.pursuer == "person":
            raise ConfigurationError(
                "map.source must be 'given' or 'none' with a person as "
                "pursuer, got 'seen': on a map that is being made only robots "
                "are told from obstacles"
            )
        if maps:
            if self.sensing != "cameras":
                raise ConfigurationError(
                    "sensing must be 'cameras' with map.source = 'seen', "
                    f"got {self.sensing!r}"
                )
        if any(self.robot_of(name).legs.walks for name in self.robots):
            if self.room.plan is not None and self.sensing == "cameras":
                raise ConfigurationError(
                    "legs.network must be empty in rooms with camera sensing, "
                    f"got {self.legs.network!r}"
                )
        if self.sensing == "lidar" and self.pursuer != "person":
            raise ConfigurationError(
                "sensing must be 'ideal' or 'cameras' with a robot as "
                "pursuer, got 'lidar': a lidar detects people"
            )
        check_count(self.pushes, MOST_PUSHES, "pushes")
        check_pushes(self.pushes, self.robots)

    def robot_of(self, player: str) -> RobotSettings:
        """Return robot, gait and control of a player."""
        own = self.pursuer_robot if player == PURSUER else self.evader_robot
        return own or RobotSettings(
            self.robot, self.gait, self.control, self.legs
        )

    def resolved(self) -> "DuelSettings":
        """Return the settings of the same duel with nothing left open."""
        strategy, evader = self.strategy, self.resolved_evader
        if isinstance(evader, str) and evader.startswith(f"{EVASION}("):
            made = load_strategy(evader, strategy)
            if type(made) is Evasion:  # of the paper, by other arguments
                return replace(
                    self, strategy=made, evader_strategy=EVASION
                ).resolved()
        if self.uses_evasion:
            strategy = implied_trigger(
                strategy,
                self.robot_of(EVADER).gait,
                person=self.pursuer == "person",
            )
        pursuer, evading = self.pursuer_robot, self.evader_robot
        return replace(
            self,
            strategy=strategy,
            evader_strategy=evader,
            control=implied_control(self.control, self.gait, self.body),
            pursuer_robot=pursuer and pursuer.resolved(self.body),
            evader_robot=evading and evading.resolved(self.body),
        )

    @property
    def resolved_evader(self) -> str | Strategy:
        """Strategy of the evader, also if it is left open."""
        return self.evader_strategy or implied_evader(
            self.robot_of(EVADER).legs, person=self.pursuer == "person"
        )

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
        played = (self.resolved_evader, self.pursuer_strategy)
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
    def has_things(self) -> bool:
        """Whether there are obstacles besides the players."""
        return bool(self.room.things or self.room.plan)

    @property
    def both(self) -> str:
        """Both players, as text: "both robots" or "both players"."""
        return "both robots" if self.pursuer == "robot" else "both players"

    @property
    def is_of_the_paper(self) -> bool:
        """Whether both strategies are those of the paper, without a room."""
        played = (self.resolved_evader, self.pursuer_strategy)
        return self.room.plan is None and played == (EVASION, PURSUIT)


def load_evader(settings: DuelSettings) -> Strategy:
    """Load the strategy of the evader, within its shield if it has one."""
    settings = settings.resolved()
    strategy = load_strategy(settings.evader_strategy, settings.strategy)
    return shielded(strategy, settings.shield)
