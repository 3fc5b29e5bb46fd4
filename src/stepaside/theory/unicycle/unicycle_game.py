"""Parameters of the game of two unicycles, eqs. (1)-(6) of the paper."""

from dataclasses import dataclass
from enum import StrEnum
from math import atan2, cos, hypot, pi, sin
from typing import Never

from ...core.errors import (
    PlanError,
    check_bearing,
    check_positive,
    check_within,
    shown,
)
from ...core.poses import Pose, wrap_angle

MOVE_BACK = 0.0
"""Evasion angle of "move back", in [rad]."""
MOVE_ASIDE = pi / 2
"""Evasion angle of "move aside", in [rad]."""


class _Choice(StrEnum):
    """Values by name."""

    @classmethod
    def _missing_(cls, value: object) -> Never:
        raise PlanError(
            f"{cls.__name__} must be one of {', '.join(cls)}, "
            f"got {shown(value)}"
        )


class TurningLaw(_Choice):
    """Law from the evader's heading error to its turning rate."""

    PROPORTIONAL = "proportional"  # eq. (4)
    SATURATED = "saturated"  # eq. (6)


class SideRule(_Choice):
    """Rule for the side of the line of sight to which the evader moves.

    ``BEHIND`` takes, at every instant, the direction behind the evader
    (Sec. II-B), with an optional hysteresis. ``LATCHED`` keeps the initial
    side.
    """

    BEHIND = "behind"
    LATCHED = "latched"


@dataclass(frozen=True, slots=True)
class Unicycle:
    """Parameters of one player.

    Attributes:
        speed: Magnitude of the driving velocity, in [m/s]. The pursuer
            drives forward (1), the evader backward (3).
        gain: Steering gain :math:`k`, in [1/s]; in (6) it is the turning
            rate itself, in [rad/s].
    """

    speed: float
    gain: float


@dataclass(frozen=True, slots=True)
class Game:
    r"""Parameters of a game.

    With :math:`\psi` the bearing of the pursuer in the evader's frame and
    :math:`\sigma = \pm 1` the side, the evader's error is
    :math:`b = \psi + \sigma \alpha`; behind the evader means
    :math:`\sigma = -\mathrm{sign}\,\psi`. Eq. (5) is
    :math:`\alpha = \pi / 2`, :math:`\sigma = 1`. Errors are wrapped to
    :math:`[-\pi, \pi]`, which is part of the model.

    Attributes:
        pursuer: Speed and gain of the pursuer.
        evader: Speed and gain of the evader.
        angle: Evasion angle :math:`\alpha` in [0, pi], in [rad].
        law: Turning law of the evader, (4) or (6).
        side_rule: How the side is chosen.
        hysteresis: The side flips only when the pursuer's bearing is this
            far beyond the evader's axis, in [rad]; for ``BEHIND`` only.
    """

    pursuer: Unicycle
    evader: Unicycle
    angle: float = MOVE_ASIDE
    law: TurningLaw = TurningLaw.PROPORTIONAL
    side_rule: SideRule = SideRule.BEHIND
    hysteresis: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters; messages use the names of the options."""
        check_positive(self.pursuer.speed, "pursuer_speed", "m/s")
        check_positive(self.evader.speed, "evader_speed", "m/s")
        check_positive(self.pursuer.gain, "pursuer_gain", "1/s")
        check_positive(self.evader.gain, "evader_gain", "1/s")
        check_within(self.angle, 0.0, pi, "angle", "rad")
        largest = min(self.angle, pi - self.angle)
        check_within(self.hysteresis, 0.0, largest, "hysteresis", "rad")

    @property
    def numbers(self) -> tuple[float, float, float, float, float]:
        """Speeds of pursuer and evader, their gains, and the angle."""
        own, other = self.pursuer, self.evader
        speeds = float(own.speed), float(other.speed)
        return *speeds, float(own.gain), float(other.gain), float(self.angle)

    @property
    def saturated(self) -> bool:
        """Whether the evader turns by (6) rather than by (4)."""
        return self.law is TurningLaw.SATURATED

    @property
    def keeps_side(self) -> bool:
        """Whether the side never changes.

        At angles 0 and pi both sides are the same direction.
        """
        ends = self.angle in (0.0, pi)
        return ends or self.side_rule is SideRule.LATCHED


def check_side(side: int) -> None:
    """Raise :class:`PlanError` unless a side is -1, 1, or 0 for none."""
    if side not in (-1, 0, 1):
        raise PlanError(f"side must be -1 or 1, got {shown(side)}")


def make_game(
    pursuer_speed: float,
    evader_speed: float,
    pursuer_gain: float,
    evader_gain: float,
    angle: float = MOVE_ASIDE,
    law: TurningLaw | str = TurningLaw.PROPORTIONAL,
    *,
    side_rule: SideRule | str = SideRule.BEHIND,
    hysteresis: float = 0.0,
) -> Game:
    """Build a game from plain values; see :class:`Game` for units."""
    return Game(
        Unicycle(pursuer_speed, pursuer_gain),
        Unicycle(evader_speed, evader_gain),
        angle,
        TurningLaw(law),
        SideRule(side_rule),
        hysteresis,
    )


@dataclass(frozen=True, slots=True)
class RelativeStart:
    r"""Relative coordinates of two unicycles; see :mod:`.relative_motion`.

    Attributes:
        distance: Distance :math:`r`, in [m].
        pursuer_error: Bearing :math:`a` of the evader in the pursuer's
            frame, which is the error of (2), in [rad].
        bearing: Bearing :math:`\psi` of the pursuer in the evader's frame,
            in [rad]; zero if the evader faces the pursuer.
    """

    distance: float
    pursuer_error: float = 0.0
    bearing: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        check_positive(self.distance, "distance", "m")
        check_bearing(self.pursuer_error, "pursuer_error")
        check_bearing(self.bearing, "bearing")

    @classmethod
    def from_world(cls, pursuer: Pose, evader: Pose) -> "RelativeStart":
        """Compute relative coordinates of two poses in a common frame."""
        dx, dy = evader.x - pursuer.x, evader.y - pursuer.y
        sight = atan2(dy, dx)
        return cls(
            hypot(dx, dy),
            wrap_angle(sight - pursuer.theta),
            wrap_angle(sight + pi - evader.theta),
        )

    def wrapped(self) -> tuple[float, float, float]:
        """Return the distance [m] and both angles in [-pi, pi] [rad]."""
        a, psi = wrap_angle(self.pursuer_error), wrap_angle(self.bearing)
        return self.distance, a, psi

    def poses(self) -> tuple[Pose, Pose]:
        """Return the poses of both in the initial frame of the pursuer."""
        r, sight = self.distance, self.pursuer_error
        turned = sight + pi - self.bearing
        return Pose(0.0, 0.0, 0.0), Pose(
            r * cos(sight), r * sin(sight), turned
        )
