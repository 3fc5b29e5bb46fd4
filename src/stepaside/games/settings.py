"""Settings of a duel: one value that repeats it."""

from dataclasses import dataclass, field
from math import pi

from ..control.balance.settings import ControlSettings
from ..errors import ConfigurationError, check_positive, check_within
from ..planning import GaitSettings
from ..strategies import Evasion
from ..strategies.registry import check_strategy_name
from ..world.body_settings import BodySettings
from ..world.camera_settings import CameraSettings, RoomSettings
from ..world.person_settings import PersonSettings, check_pursuer
from ..world.settings import PhysicsSettings, SightSettings

ERROR = ConfigurationError
SENSING = ("ideal", "cameras")
PLAYERS = PURSUER, EVADER = ("pursuer", "evader")
EVASION, PURSUIT = "evasion", "pursuit"  # strategies of the paper


def _short(value: object) -> str:
    """A value for a message; Python writes no number of any length."""
    huge = isinstance(value, int) and abs(value) >= 2**128
    return "one that is longer" if huge else repr(value)


@dataclass(frozen=True, slots=True)
class StartSettings:
    """Where the robots stand at first; what is left out, the seed draws.

    Attributes:
        distance: Distance between the torsos, in [m]; drawn from
            0.6 m to 1.5 m.
        pursuer_offset: Heading of the pursuer from the direction of the
            evader, in [rad]; drawn from -90 deg to 90 deg.
        evader_offset: Heading of the evader from the direction of the
            pursuer, in [rad]; drawn from -30 deg to 30 deg.
    """

    distance: float | None = None
    pursuer_offset: float | None = None
    evader_offset: float | None = None

    def __post_init__(self) -> None:
        """Refuse starts that overlap or are not finite."""
        if self.distance is not None:
            check_within(self.distance, 0.4, 100.0, "distance", "m", ERROR)
        for name in ("pursuer_offset", "evader_offset"):
            value = getattr(self, name)
            if value is not None:
                check_within(value, -pi, pi, name, "rad", ERROR)


@dataclass(frozen=True, slots=True)
class DuelSettings:
    """Everything that decides a duel.

    Attributes:
        seed: Seed of every random draw.
        duration: Simulated time, in [s].
        robot: Name of a robot or folder of its description.
        start: Where the robots stand at first.
        strategy: How an evader of the paper evades.
        evader_strategy: What the evader plays: "evasion" as the paper's,
            another name of :data:`~stepaside.strategies.STRATEGIES`, or
            FILE.py:NAME.
        pursuer_strategy: What a pursuing robot plays, likewise.
        gait: How both walk.
        sight: What they see.
        physics: Physics, floor and clock.
        body: How far the bodies are from ideal ones.
        control: How both control their walk.
        sensing: "ideal" for the line of sight of ``sight``, or "cameras".
        cameras: What they see with, if with cameras.
        room: What stands around them, if they see with cameras.
        pursuer: "robot", or "person".
        person: How a person walks.
    """

    seed: int = 1
    duration: float = 120.0
    robot: str = "nao"
    start: StartSettings = field(default_factory=StartSettings)
    strategy: Evasion = field(default_factory=Evasion)
    evader_strategy: str = EVASION
    pursuer_strategy: str = PURSUIT
    gait: GaitSettings = field(default_factory=GaitSettings)
    sight: SightSettings = field(default_factory=SightSettings)
    physics: PhysicsSettings = field(default_factory=PhysicsSettings)
    body: BodySettings = field(default_factory=BodySettings)
    control: ControlSettings = field(default_factory=ControlSettings)
    sensing: str = "ideal"
    cameras: CameraSettings = field(default_factory=CameraSettings)
    room: RoomSettings = field(default_factory=RoomSettings)
    pursuer: str = "robot"
    person: PersonSettings = field(default_factory=PersonSettings)

    def __post_init__(self) -> None:
        """Refuse a negative seed, a duration that is none, other senses."""
        check_pursuer(self.pursuer)
        check_strategy_name(self.evader_strategy, "evader_strategy")
        check_strategy_name(self.pursuer_strategy, "pursuer_strategy")
        if self.pursuer == "person" and self.pursuer_strategy != PURSUIT:
            raise ConfigurationError(
                f"pursuer_strategy must be {PURSUIT!r} for a person, who "
                f"walks as person.path says, got {self.pursuer_strategy!r}"
            )
        if self.sensing not in SENSING:
            raise ConfigurationError(
                f"sensing must be one of {', '.join(SENSING)}, "
                f"got {self.sensing!r}"
            )
        whole = type(self.seed) is int
        if not whole or not 0 <= self.seed < 2**128:
            raise ConfigurationError(
                f"seed must be an integer >= 0 [1] of at most 128 bits, got "
                f"{_short(self.seed)}"
            )
        check_within(self.duration, 0.0, 86400.0, "duration", "s", ERROR)
        check_positive(self.duration, "duration", "s", ERROR)

    @property
    def is_of_the_paper(self) -> bool:
        """Whether both play as in the paper, so that its theory holds."""
        return (self.evader_strategy, self.pursuer_strategy) == (
            EVASION,
            PURSUIT,
        )
