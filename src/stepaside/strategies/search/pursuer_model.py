"""Model of a pursuer's steps, and the rules of a search against it."""

from math import atan2, cos, floor, pi, sin, sqrt, tau
from typing import NamedTuple

from ...core.compilation import inlined


class PursuerModel(NamedTuple):
    """Model of a pursuer's steps.

    Attributes:
        ratio: Turn of a step per bearing of its target, by the gait's.
        inward: Weight of the centre of the room in the direction that it
            heads for; 1 for the pursuer of :mod:`..herding`.
        lead: Distance of its target ahead of the evader, as a fraction of
            the distance between the players.
        speed: Its stride over that of the evader.
    """

    ratio: float = 1.0
    inward: float = 0.0
    lead: float = 0.0
    speed: float = 1.0


class BeamRules(NamedTuple):
    """Rules of the steps, and size of the search.

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


@inlined
def arc_chord(way: float, turn: float) -> float:
    """Return the chord [m] of an arc of a length [m] and a turn [rad]."""
    z = 0.25 * turn * turn
    return way * (1.0 - z / 6.0 * (1.0 - z / 20.0))


@inlined
def arc_end(
    pose: tuple[float, float, float], way: float, turn: float
) -> tuple[float, float, float]:
    """Return the pose after an arc of a length [m] and a turn [rad]."""
    chord = arc_chord(way, turn)
    x, y, theta = pose
    along = theta + 0.5 * turn
    return x + chord * cos(along), y + chord * sin(along), theta + turn


@inlined
def model_turn(
    evader: tuple[float, float, float],
    pursuer: tuple[float, float, float],
    model: PursuerModel,
    rules: BeamRules,
) -> float:
    """Return the turn of the pursuer's step by a model, in [rad].

    Args:
        evader: Pose (x [m], y [m], theta [rad]) in a frame whose origin is
            the centre of the room.
        pursuer: Likewise.
        model: Model of the pursuer.
        rules: Rules of the steps.
    """
    px, py, heading = pursuer
    dx, dy = evader[0] - px, evader[1] - py
    away = sqrt(dx * dx + dy * dy) + 1e-12
    if model.lead != 0.0:
        # It walks backward.
        dx -= model.lead * away * cos(evader[2])
        dy -= model.lead * away * sin(evader[2])
    inward = sqrt(px * px + py * py)
    if model.inward != 0.0 and inward > 1e-6:
        dx = dx / away - model.inward * px / inward
        dy = dy / away - model.inward * py / inward
    aim = atan2(dy, dx) - heading
    aim -= tau * floor(aim / tau + 0.5)
    wanted = min(max(model.ratio * aim, -pi), pi)
    turn: float = min(max(rules.share * wanted, -rules.largest), rules.largest)
    return turn
