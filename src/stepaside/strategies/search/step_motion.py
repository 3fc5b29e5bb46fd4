r"""Motion of both players in one step, in compiled loops.

In one step a robot advances by a stride along an arc and turns by `u`. The
pursuer of eqs. (1)-(2) turns by :math:`\kappa` times the bearing of the
evader, :math:`\kappa = k \Delta / \bar{v}`; models of other pursuers are
those of :class:`~stepaside.strategies.Pursuit`. The headings are unit vectors
to save trigonometric functions.
"""

from math import atan2, cos, sin, sqrt
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


class PursuerModel(NamedTuple):
    """Model of a pursuer's steps, of the family of :class:`..Pursuit`.

    Attributes:
        gain: Turn of a step per bearing of its target, by the gait's.
        pull: Weight of the centre of the room, the origin of the frame, in
            the direction that it heads for.
        lead: Distance of its target ahead of the evader, as a fraction of
            the distance between the players.
        speed: Its stride over that of the evader.
    """

    gain: float = 1.0
    pull: float = 0.0
    lead: float = 0.0
    speed: float = 1.0


class StepRules(NamedTuple):
    """Rules of a step, alike for both players.

    Attributes:
        stride: Stride of the evader, in [m].
        share: Turn of a step per desired heading, kappa.
        largest: Largest turn of a step, in [rad]: pi kappa.
    """

    stride: float
    share: float
    largest: float


class BeamRules(NamedTuple):
    """Rules of a step, and of the games and the size of a beam search.

    Attributes:
        stride: Stride of the evader, in [m].
        share: Turn of a step per desired heading, kappa.
        largest: Largest turn of a step, in [rad].
        capture: Capture distance, in [m].
        clearance: Least clearance of the evader's centre, in [m].
        width: Number of states that go on.
        horizon: Number of steps.
        caution: Worth of the least distance of a game so far, in [m] per
            [m], at most 3.
    """

    stride: float
    share: float
    largest: float
    capture: float
    clearance: float
    width: int
    horizon: int
    caution: float = 0.0


Rules = StepRules | BeamRules


def pair_of(
    evader: tuple[float, float, float], pursuer: tuple[float, float, float]
) -> PlayerPair:
    """Return two poses (x [m], y [m], theta [rad]) with unit vectors."""
    (x, y, e), (u, v, p) = evader, pursuer
    return PlayerPair(x, y, cos(e), sin(e), u, v, cos(p), sin(p))


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
def pursuer_turn(both: PlayerPair, model: PursuerModel, rules: Rules) -> float:
    """Return the turn of the pursuer's step by a model, in [rad]."""
    dx, dy = both.ex - both.px, both.ey - both.py
    if model.lead != 0.0:
        reach = model.lead * sqrt(dx * dx + dy * dy)
        dx -= reach * both.ec  # it walks backward
        dy -= reach * both.es
    if model.pull != 0.0:
        inward = sqrt(both.px * both.px + both.py * both.py)
        if inward > 1e-6:
            weight = model.pull * sqrt(dx * dx + dy * dy) / inward
            dx -= weight * both.px
            dy -= weight * both.py
    aim = atan2(both.pc * dy - both.ps * dx, both.pc * dx + both.ps * dy)
    turn: float = rules.share * aim
    if model.gain != 1.0:
        turn *= model.gain
        turn = min(max(turn, -rules.largest), rules.largest)
    return turn


@inlined
def pursue(
    both: PlayerPair, model: PursuerModel, rules: Rules
) -> tuple[float, float, float, float]:
    """Return the pursuer's position and heading vector after a step."""
    c, s, ratio = half_turn(0.5 * pursuer_turn(both, model, rules))
    mc, ms = both.pc * c - both.ps * s, both.ps * c + both.pc * s
    way = model.speed * rules.stride * ratio
    return (
        both.px + way * mc,
        both.py + way * ms,
        mc * c - ms * s,
        ms * c + mc * s,
    )


@inlined
def step_both(
    both: PlayerPair,
    half: tuple[float, float, float],
    pace: float,
    model: PursuerModel,
    rules: Rules,
) -> PlayerPair:
    """Advance both players by one step.

    Args:
        both: Poses of both players.
        half: Cosine, sine and sinc of half the evader's turn
            (:func:`half_turn`).
        pace: Fraction of the stride that the evader makes.
        model: Model of the pursuer.
        rules: Rules of the step.
    """
    c, s, ratio = half
    mc, ms = both.ec * c - both.es * s, both.es * c + both.ec * s
    way = pace * rules.stride * ratio
    px, py, pc, ps = pursue(both, model, rules)
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
