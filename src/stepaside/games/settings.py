"""Settings of a duel: one value that repeats it."""

from dataclasses import dataclass, field
from math import inf, pi, radians

from ..control.balance.settings import ControlSettings
from ..errors import ConfigurationError, check_positive, check_within
from ..planning import GaitSettings
from ..strategies.roles import Evasion
from ..world.body_settings import BodySettings
from ..world.camera_settings import CameraSettings, RoomSettings
from ..world.person_settings import PersonSettings, check_pursuer
from ..world.settings import PhysicsSettings, SightSettings

ERROR = ConfigurationError
SENSING = ("ideal", "cameras")


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
class StrategySettings:
    """How the evader evades.

    Attributes:
        angle: Between the line of sight and where it walks, in [rad]: pi/2
            moves aside, 0 moves back.
        saturated: Whether it turns by (6) instead of (4).
        safety_radius: Distance at which it begins, in [m].
        release_distance: Distance at which it ends, in [m].
        side_hysteresis: How far the bearing of the pursuer must change sign
            for the side of evasion to change, in [rad].
    """

    angle: float = pi / 2
    saturated: bool = False
    safety_radius: float = 0.8
    release_distance: float = inf
    side_hysteresis: float = radians(20.0)

    def __post_init__(self) -> None:
        """Refuse what no evader can do."""
        self.role()

    def role(self) -> Evasion:
        """Role of an evader that has not seen anybody yet."""
        return Evasion(
            self.angle,
            self.safety_radius,
            self.release_distance,
            self.saturated,
            self.side_hysteresis,
        )


@dataclass(frozen=True, slots=True)
class DuelSettings:
    """Everything that decides a duel.

    Attributes:
        seed: Seed of every random draw.
        duration: Simulated time, in [s].
        robot: Name of a robot or folder of its description.
        start: Where the robots stand at first.
        strategy: How the evader evades.
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
    strategy: StrategySettings = field(default_factory=StrategySettings)
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
        if self.sensing not in SENSING:
            raise ConfigurationError(
                f"sensing must be one of {', '.join(SENSING)}, "
                f"got {self.sensing!r}"
            )
        if not isinstance(self.seed, int) or self.seed < 0:
            raise ConfigurationError(
                f"seed must be an integer >= 0 [1], got {self.seed}"
            )
        check_within(self.duration, 0.0, 86400.0, "duration", "s", ERROR)
        check_positive(self.duration, "duration", "s", ERROR)
