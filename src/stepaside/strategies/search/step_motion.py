r"""Motion of both players in one step of the step game.

In one step a robot advances by the stride along an arc and turns by `u`. The
pursuer of eqs. (1)-(2) turns by :math:`\kappa` times the bearing of the
evader, :math:`\kappa = k \Delta / \bar{v}`. The headings are unit
vectors to save trigonometric functions.
"""

from math import atan2
from typing import NamedTuple

from ...core.compilation import inlined


class PlayerPair(NamedTuple):
    """Poses of both players in one frame.

    Attributes:
        ex: Position of the evader, in [m].
        ey: Likewise.
        ec: Cosine of the evader's heading.
        es: Sine of the evader's heading.
        px: Position of the pursuer, in [m].
        py: Likewise.
        pc: Cosine of the pursuer's heading.
        ps: Sine of the pursuer's heading.
    """

    ex: float
    ey: float
    ec: float
    es: float
    px: float
    py: float
    pc: float
    ps: float


class StepRules(NamedTuple):
    """Parameters of a step of each player.

    Attributes:
        evader_stride: Step length of the evader, in [m].
        evader_share: Turn of its step per desired heading, kappa.
        pursuer_stride: Step length of the pursuer, in [m].
        pursuer_share: Turn of its step per bearing, kappa.
        lead: Lead of the pursuer's target point ahead of the evader, as a
            fraction of the distance; 0 for the paper's pursuer.
    """

    evader_stride: float
    evader_share: float
    pursuer_stride: float
    pursuer_share: float
    lead: float = 0.0


@inlined
def half_turn(half: float) -> tuple[float, float, float]:
    """Return cosine, sine and sinc of half the turn of a step.

    Power series, accurate to 1e-9 up to 0.4 rad.
    """
    z = half * half
    ratio = 1.0 - z * (1.0 / 6.0 - z * (1.0 / 120.0 - z * (1.0 / 5040.0)))
    ratio += z * z * z * z * (1.0 / 362880.0)
    cosine = 1.0 - z * (0.5 - z * (1.0 / 24.0 - z * (1.0 / 720.0)))
    cosine += z * z * z * z * (1.0 / 40320.0)
    return cosine, half * ratio, ratio


@inlined
def pursue(
    both: PlayerPair, rules: StepRules
) -> tuple[float, float, float, float]:
    """Return the pursuer's position and heading vector after a step."""
    dx, dy = both.ex - both.px, both.ey - both.py
    if rules.lead != 0.0:
        reach = rules.lead * (dx * dx + dy * dy) ** 0.5
        dx -= reach * both.ec  # it walks backward
        dy -= reach * both.es
    aim = atan2(both.pc * dy - both.ps * dx, both.pc * dx + both.ps * dy)
    half = 0.5 * rules.pursuer_share * aim
    c, s, ratio = half_turn(half)
    mc, ms = both.pc * c - both.ps * s, both.ps * c + both.pc * s
    way = rules.pursuer_stride * ratio
    return (
        both.px + way * mc,
        both.py + way * ms,
        mc * c - ms * s,
        ms * c + mc * s,
    )


@inlined
def step_both(
    both: PlayerPair, c: float, s: float, ratio: float, rules: StepRules
) -> PlayerPair:
    """Advance both players by one step.

    Args:
        both: Poses of both players.
        c: Cosine of half the evader's turn; see :func:`half_turn`.
        s: Its sine.
        ratio: Its sinc.
        rules: Parameters of the steps.
    """
    mc, ms = both.ec * c - both.es * s, both.es * c + both.ec * s
    way = rules.evader_stride * ratio
    px, py, pc, ps = pursue(both, rules)
    return PlayerPair(
        both.ex - way * mc,
        both.ey - way * ms,
        mc * c - ms * s,
        ms * c + mc * s,
        px,
        py,
        pc,
        ps,
    )
