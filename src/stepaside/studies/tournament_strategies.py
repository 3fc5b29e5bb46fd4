"""Gains of pursuers in a tournament, and the evader that moves aside."""

from math import inf, radians

from ..strategies import Pursuit, load_strategy
from ..strategies.registry import file_of

SIGHT = radians(148.0)  # greatest bearing in view of a turned head, in [rad]
ASIDE = "evasion(safety_radius=100)"  # beyond every distance of these games


def gain_of(name: str) -> float | None:
    """Return the gain of a pursuer by the evader's; None if not by eq. (2)."""
    if file_of(name) is not None:
        return None
    strategy = load_strategy(name)
    gain = getattr(strategy, "gain", inf)
    is_papers = gain < inf and strategy == Pursuit(gain=gain)
    return gain if is_papers else None
