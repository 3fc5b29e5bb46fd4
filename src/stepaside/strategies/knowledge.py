"""Input and output of a decision: knowledge and intent of a player."""

from dataclasses import dataclass, replace
from math import atan2, cos, hypot, pi, sin, tau
from typing import NamedTuple

from ..arena import NO_OBSTACLES, ObstacleSet
from ..core.errors import check_within
from ..core.player_identity import PlayerIdentity
from ..core.poses import ALL_AROUND, Pose, Sector, wrap_angle
from ..core.ranges import Range
from ..planning import GaitSettings
from ..planning.gait_settings import stride_share
from .velocity_set import STILL, BodyVelocity, VelocitySet

FASTEST = 100.0  # desired velocity; more is an error, in [m/s] and [rad/s]
BODY = Range(0.0, 10.0, "m", "a body has a radius", above=True)
MAX_HEADING = 0.5 * pi  # desired heading of the sharpest turn, in [rad]


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of the own gait."""

    speed: float  # of the template at factor 1 [m/s] of path time
    gain: float  # k [1/s] of path time; in (6) the turning rate [rad/s]
    stride: float  # length of one step at speed factor 1 [m]
    step_duration: float  # time between decisions while walking [s]
    velocities: VelocitySet | None = None  # None for a unicycle
    outer_stride: float | None = None  # in a turn [m]; None for any
    foot_spacing: float = 0.0  # coronal distance between the feet [m]
    views: tuple[Sector, ...] = ALL_AROUND  # where it sees others

    @property
    def share(self) -> float:
        """Turn of a step per desired heading, kappa."""
        return self.gain * self.stride / self.speed

    def correcting_heading(self, error: float) -> float:
        """Return the desired heading that corrects an error fastest, in [rad].

        A step turns by a fraction of its desired heading: a larger one turns
        by the whole error in one step, up to the sharpest turn.
        """
        heading = wrap_angle(error) / self.share
        return min(max(heading, -MAX_HEADING), MAX_HEADING)

    def stride_share(self, turn: float) -> float:
        """Return the fraction of the stride that a turn [rad] allows."""
        return stride_share(
            turn, self.stride, self.outer_stride, self.foot_spacing
        )


def limits_of(
    gait: GaitSettings,
    velocities: VelocitySet | None = None,
    views: tuple[Sector, ...] = ALL_AROUND,
) -> Limits:
    """Return the limits of the gait of a walker, or of a template of legs."""
    step = gait.speed, gait.gain, gait.stride, gait.step_duration
    return Limits(
        *step, velocities, gait.outer_stride, gait.foot_spacing, views
    )


class OtherPlayer(NamedTuple):
    """Knowledge of one other player, in the frame of :class:`Knowledge`."""

    identity: PlayerIdentity  # name, role and team
    bearing: float  # direction in the frame, in [-pi, pi] [rad]
    distance: float  # horizontal distance at the sighting [m]
    # velocity over the floor, components ahead and to the left in the frame
    # [m/s]; None until it is known
    velocity: tuple[float, float] | None = None
    age: float = 0.0  # time since the sighting [s]
    spread: float = 0.0  # standard deviation of the position [m]

    @property
    def position(self) -> tuple[float, float]:
        """Position ahead and to the left in the frame, in [m]."""
        bearing, distance = self.bearing, self.distance
        return distance * cos(bearing), distance * sin(bearing)


@dataclass(frozen=True, slots=True)
class Knowledge:
    """Knowledge of a player at a decision: the opponent, itself, obstacles.

    In a game of several players the opponent is the assigned target, or else
    the nearest one; ``others`` lists every player that has been seen.

    The frame is the pose of the template unicycle at the time of the
    sighting: for a walker midway between its feet, along its path. So the
    bearing compares a line of sight with a heading of the same instant.
    """

    time: float  # present time [s]
    bearing: float  # of the opponent in the frame [rad], positive left
    distance: float  # horizontal distance to the opponent at the sighting [m]
    limits: Limits  # limits of the own gait
    bearing_rate: float | None = None  # of the line of sight [rad/s]
    closing_speed: float | None = None  # None until it is known [m/s]
    age: float = 0.0  # time since the sighting [s]
    # pose of the frame in the map: the frame of a known room, else the own
    # odometry
    pose_in_map: Pose = Pose(0.0, 0.0, 0.0)
    moving: bool = False  # whether the body is walking
    obstacles_in_map: ObstacleSet = NO_OBSTACLES  # walls included
    # velocity of the opponent over the floor, components ahead and to the left
    # in the frame [m/s]; None until it is known
    velocity: tuple[float, float] | None = None
    # pose at which the decided step begins; None if that is ``pose_in_map``. A
    # walker decides when a foot has landed, and its body passes that foot half
    # a step later
    step_start_in_map: Pose | None = None
    spread: float = 0.0  # standard deviation of the opponent's position [m]
    map_error: float = 0.0  # largest position error of the obstacles [m]
    identity: PlayerIdentity | None = None  # None if not told apart
    # all other players that have been seen, the opponent among them; empty if
    # sightings do not tell who was seen
    others: tuple[OtherPlayer, ...] = ()

    def __post_init__(self) -> None:
        """Check the bearing."""
        bearing = self.bearing  # most are valid, and spare a call
        if type(bearing) is not float or not -tau <= bearing <= tau:
            check_within(bearing, -tau, tau, "bearing", "rad")

    @property
    def position(self) -> tuple[float, float]:
        """Position of the opponent ahead and to the left, in [m]."""
        bearing, distance = self.bearing, self.distance
        return distance * cos(bearing), distance * sin(bearing)

    @property
    def position_in_map(self) -> tuple[float, float]:
        """Position of the opponent in the map, in [m]."""
        x, y, theta = self.pose_in_map
        sight, distance = theta + self.bearing, self.distance
        return x + distance * cos(sight), y + distance * sin(sight)

    @property
    def knows_obstacles(self) -> bool:
        """Whether it knows of any obstacle."""
        known = self.obstacles_in_map
        return known is not NO_OBSTACLES and bool(known)

    @property
    def opponents(self) -> tuple[OtherPlayer, ...]:
        """The others that have an opposing role."""
        own = self.identity
        return tuple(o for o in self.others if own and own.opposes(o.identity))

    @property
    def teammates(self) -> tuple[OtherPlayer, ...]:
        """The others of the own team."""
        own = self.identity
        return tuple(o for o in self.others if own and own.is_with(o.identity))

    def about(self, other: OtherPlayer) -> "Knowledge":
        """Return the same knowledge with another player as the opponent."""
        x, y = other.position
        return self.towards(x, y, other.velocity, other.age, other.spread)

    def towards(
        self,
        x: float,
        y: float,
        velocity: tuple[float, float] | None = (0.0, 0.0),
        age: float = 0.0,
        spread: float = 0.0,
    ) -> "Knowledge":
        """Return the same knowledge with a point as the opponent.

        The point is given ahead and to the left in the frame, in [m]. Rates of
        the line of sight are those of the present opponent, and left out.
        """
        return replace(
            self,
            bearing=atan2(y, x),
            distance=hypot(x, y),
            bearing_rate=None,
            closing_speed=None,
            age=age,
            velocity=velocity,
            spread=spread,
        )


@dataclass(frozen=True, slots=True)
class Intent:
    """Intent of a player: desired heading and speed, or body velocity."""

    # desired heading in the frame of the knowledge [rad]; it sets the turning
    # rate from the next step on
    heading: float = 0.0
    speed_factor: float = 1.0  # fraction of the gait's speed [0, 1]; 0 stops
    # desired velocity of the body in its present frame, in place of heading
    # and speed. Legs with a velocity set walk at the nearest velocity in it,
    # unicycles follow :func:`~stepaside.strategies.strategy.unicycle_intent`
    velocity: BodyVelocity | None = None

    def __post_init__(self) -> None:
        """Validate the intent."""
        heading, factor = self.heading, self.speed_factor
        if type(heading) is not float or not -tau <= heading <= tau:
            check_within(heading, -tau, tau, "heading", "rad")
        if type(factor) is not float or not 0.0 <= factor <= 1.0:
            check_within(factor, 0.0, 1.0, "speed_factor", "1")
        if self.velocity is not None:
            for name, value in self.velocity._asdict().items():
                unit = "rad/s" if name == "turn" else "m/s"
                check_within(value, -FASTEST, FASTEST, name, unit)

    @property
    def walks(self) -> bool:
        """Whether it requests any motion."""
        return bool(self.speed_factor > 0.0 and self.velocity != STILL)


ON_THE_SPOT = 0.05  # speed factor of a turn on the spot

STAND = Intent(speed_factor=0.0)
"""Intent to stand, or to come to rest."""
