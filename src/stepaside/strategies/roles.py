"""From the line of sight to a desired direction (paper, Sec. II).

Pursuer and evader are one scheme with two differences: the sign of the
driving velocity, and this rule.
"""

from dataclasses import dataclass
from math import copysign, inf, pi, radians
from typing import Protocol

from ..errors import ConfigurationError, check_positive, check_within
from ..planning import Direction
from ..poses import wrap_angle


class Role(Protocol):
    """A player's way to turn what it sees into where it heads.

    Attributes:
        direction: Whether the robot walks forward or backward.
        saturated: Whether it turns by (6) instead of (8).
    """

    @property
    def direction(self) -> Direction:
        """Whether the robot walks forward or backward."""

    @property
    def saturated(self) -> bool:
        """Whether it turns by (6) instead of (8)."""

    def is_triggered(self, distance: float) -> bool:
        """Whether to move when the other is at a distance, in [m]."""

    def desired_heading(self, bearing: float) -> float:
        """Desired heading for a bearing of the other, both in [rad]."""


@dataclass(slots=True)
class Pursuit:
    """Head for the other, always (Sec. II-A)."""

    saturated: bool = False

    @property
    def direction(self) -> Direction:
        """Forward."""
        return Direction.FORWARD

    def is_triggered(self, distance: float) -> bool:
        """Return true: the pursuer is always aware of the evader."""
        return True

    def desired_heading(self, bearing: float) -> float:
        """Point at the other: theta* = theta_aim, eq. (2)."""
        return bearing


@dataclass(slots=True)
class Evasion:
    r"""Walk backwards across the line of sight (Sec. II-B).

    With :math:`\psi` the bearing of the pursuer in the evader's own frame,
    :math:`\theta^* = \psi - \sigma \alpha`. The side :math:`\sigma` is
    sign(psi), which takes the normal to the line of sight *behind* the
    robot; it is latched when evasion begins and changes only when psi has
    clearly changed sign, so that noise does not flip it, neither at psi = 0
    nor where psi wraps at pi. Eq. (5) as printed, with an angle other than
    pi/2, would walk into the pursuer.

    Attributes:
        angle: Strategy :math:`\alpha`, in [rad]: pi/2 moves aside, 0 moves
            back.
        safety_radius: Distance at which evasion begins, in [m].
        release_distance: Distance at which it ends, in [m].
        saturated: Whether to turn by (6) instead of (8).
        side_hysteresis: How far psi must be past 0 or past pi for the side
            to change, in [rad]; from pi/2 on it never does.
    """

    angle: float = pi / 2
    safety_radius: float = 0.8
    release_distance: float = inf
    saturated: bool = False
    side_hysteresis: float = radians(20.0)
    side: float | None = None
    evading: bool = False

    def __post_init__(self) -> None:
        """Refuse what no evader can do."""
        error = ConfigurationError
        check_within(self.angle, 0.0, pi, "angle", "rad", error)
        check_positive(self.safety_radius, "safety_radius", "m", error)
        check_within(
            self.side_hysteresis, 0.0, pi, "side_hysteresis", "rad", error
        )
        if not self.release_distance > self.safety_radius:
            raise ConfigurationError(
                "release_distance must exceed safety_radius, "
                f"{self.safety_radius:g} [m], or evasion stops and starts, "
                f"got {self.release_distance}"
            )

    @property
    def direction(self) -> Direction:
        """Backward."""
        return Direction.BACKWARD

    def is_triggered(self, distance: float) -> bool:
        """Latch evasion between the safety radius and the release."""
        if self.evading:
            self.evading = distance < self.release_distance
        else:
            self.evading = distance < self.safety_radius
        if not self.evading:
            self.side = None
        return self.evading

    def desired_heading(self, bearing: float) -> float:
        """Keep the line of sight at the strategy angle, behind the robot."""
        if self.side is None:
            self.side = copysign(1.0, bearing)
        past = -self.side * bearing  # how far psi is on the other side
        if self.side_hysteresis < past < pi - self.side_hysteresis:
            self.side = -self.side
        return wrap_angle(bearing - self.side * self.angle)


@dataclass(frozen=True, slots=True)
class Walk:
    """Walk with a bearing that does not depend on anybody.

    Attributes:
        bearing: Desired heading in the frame of each support foot, [rad].
        direction: Whether the robot walks forward or backward.
        saturated: Whether it turns by (6) instead of (8).
    """

    bearing: float = 0.0
    direction: Direction = Direction.FORWARD
    saturated: bool = False

    def is_triggered(self, distance: float) -> bool:
        """Return true: it always walks."""
        return True

    def desired_heading(self, bearing: float) -> float:
        """Bearing that was asked for, in [rad]."""
        return self.bearing
