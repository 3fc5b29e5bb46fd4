"""Parameters of the game of two unicycles, eqs. (1)-(6) of the paper."""

from dataclasses import KW_ONLY, dataclass
from math import pi

from ...core.errors import (
    PlanError,
    check_choice,
    check_positive,
    check_within,
    shown,
)

LAWS = ("proportional", "saturated")
"""Laws from the evader's heading error to its turning rate, (4) and (6)."""
SIDE_RULES = ("behind", "latched")
"""Rules for the side of the line of sight to which the evader moves.

``behind`` takes, at every instant, the direction behind the evader (Sec.
II-B), with an optional hysteresis. ``latched`` keeps the initial side.
"""


@dataclass(frozen=True, slots=True)
class Unicycles:
    r"""Parameters of a game.

    With :math:`\psi` the bearing of the pursuer in the evader's frame and
    :math:`\sigma = \pm 1` the side, the evader's error is
    :math:`b = \psi + \sigma \alpha`; behind the evader means
    :math:`\sigma = -\mathrm{sign}\,\psi`. Eq. (5) is
    :math:`\alpha = \pi / 2`, :math:`\sigma = 1`. Errors are wrapped to
    :math:`[-\pi, \pi]`, which is part of the model.

    Attributes:
        pursuer_speed: Speed of the pursuer, which drives forward (1), in
            [m/s].
        evader_speed: Speed of the evader, which drives backward (3), in
            [m/s].
        pursuer_gain: Steering gain :math:`k` of the pursuer, in [1/s].
        evader_gain: That of the evader; in (6) it is the turning rate itself,
            in [rad/s].
        angle: Evasion angle :math:`\alpha` in [0, pi], in [rad]: pi/2 moves
            aside, 0 moves back.
        law: Turning law of the evader, one of :data:`LAWS`.
        side_rule: How the side is chosen, one of :data:`SIDE_RULES`.
        hysteresis: The side flips only when the pursuer's bearing is this
            far beyond the evader's axis, in [rad]; for ``behind`` only.
    """

    pursuer_speed: float
    evader_speed: float
    pursuer_gain: float
    evader_gain: float
    angle: float = pi / 2
    law: str = LAWS[0]
    _: KW_ONLY
    side_rule: str = SIDE_RULES[0]
    hysteresis: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters; messages use the names of the options."""
        for name in ("pursuer_speed", "evader_speed"):
            check_positive(getattr(self, name), name, "m/s")
        for name in ("pursuer_gain", "evader_gain"):
            check_positive(getattr(self, name), name, "1/s")
        check_within(self.angle, 0.0, pi, "angle", "rad")
        check_choice(self.law, LAWS, "law")
        check_choice(self.side_rule, SIDE_RULES, "side_rule")
        largest = min(self.angle, pi - self.angle)
        check_within(self.hysteresis, 0.0, largest, "hysteresis", "rad")

    @property
    def numbers(self) -> tuple[float, float, float, float, float]:
        """Speeds of pursuer and evader, their gains, and the angle."""
        speeds = float(self.pursuer_speed), float(self.evader_speed)
        gains = float(self.pursuer_gain), float(self.evader_gain)
        return *speeds, *gains, float(self.angle)

    @property
    def saturated(self) -> bool:
        """Whether the evader turns by (6) rather than by (4)."""
        return self.law == "saturated"

    @property
    def keeps_side(self) -> bool:
        """Whether the side never changes.

        At angles 0 and pi both sides are the same direction.
        """
        return self.angle in (0.0, pi) or self.side_rule == "latched"


def check_side(side: int) -> None:
    """Raise :class:`PlanError` unless a side is -1, 1, or 0 for none."""
    if side not in (-1, 0, 1):
        raise PlanError(f"side must be -1, 0 or 1, got {shown(side)}")
