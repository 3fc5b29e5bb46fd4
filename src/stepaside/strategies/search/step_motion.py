r"""One step of both players (theory of the game in steps).

In one step a robot advances by the stride along an arc and turns by `u`. The
pursuer of eqs. (1)-(2) turns by :math:`\kappa` times the bearing of the
evader, :math:`\kappa = k \Delta / \bar{v}`. The headings are kept as unit
vectors: no sine is worked out twice.
"""

from math import atan2
from typing import NamedTuple

from ...theory.unicycle.compilation import inlined


class PlayerPair(NamedTuple):
    """Where both players are, in one frame.

    Attributes:
        ex: Of the evader, in [m].
        ey: Of the evader, in [m].
        ec: Cosine of its heading.
        es: Sine of its heading.
        px: Of the pursuer, in [m].
        py: Of the pursuer, in [m].
        pc: Cosine of its heading.
        ps: Sine of its heading.
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
    """What a step of each player does.

    Attributes:
        evader_stride: Way of a step of the evader, in [m].
        evader_share: Its turn of a step per desired heading, kappa.
        pursuer_stride: Way of a step of the pursuer, in [m].
        pursuer_share: Its turn of a step per bearing, kappa.
        lead: How far ahead of the evader the pursuer aims, as a share of
            the distance; 0 for the paper's.
    """

    evader_stride: float
    evader_share: float
    pursuer_stride: float
    pursuer_share: float
    lead: float = 0.0


@inlined
def half_turn(half: float) -> tuple[float, float, float]:
    """Cosine, sine and sine over angle of half a turn of a step.

    By series, to 1e-9 up to 0.4 rad.
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
    """Where the pursuer is a step later, and its heading as a unit vector."""
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
    """One step of both.

    Args:
        both: Where they are.
        c: Cosine of half the evader's turn; see :func:`half_turn`.
        s: Its sine.
        ratio: Its sine over the angle.
        rules: Of both.
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
