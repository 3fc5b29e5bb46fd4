"""Who plays in a tournament: strategies by name."""

from collections.abc import Callable, Mapping
from math import pi, radians

from ..errors import ConfigurationError
from ..strategies import (
    Deflected,
    Evasion,
    LeadPursuit,
    LookAhead,
    Optimal,
    OptimalPursuit,
    Pursuit,
    Strategy,
    load_strategy,
)

SIGHT = radians(148.0)  # bearing up to which a turned head sees, in [rad]
ALWAYS = 1e6  # safety radius of who evades from the first sight on, in [m]

EVADERS: Mapping[str, Callable[[float], Strategy]] = {
    "look-ahead": lambda angle: LookAhead(),
    "aside": lambda angle: Evasion(safety_radius=ALWAYS),
    "saturated": lambda angle: Evasion(saturated=True, safety_radius=ALWAYS),
    "alpha": lambda angle: Evasion(angle, safety_radius=ALWAYS),
    "deflected": lambda angle: Deflected(),
    "optimal": lambda angle: Optimal(),
}
"""Makes an evader of each name, given the angle of "alpha"."""
PURSUERS: Mapping[str, Callable[[], Strategy]] = {
    "pure": Pursuit,
    "lead": LeadPursuit,
    "optimal": OptimalPursuit,
}
"""Makes a pursuer of each name."""


def evader_of(name: str, angle: float = pi / 2) -> Strategy:
    """Evader of a name, or of FILE.py:NAME.

    Raises:
        ConfigurationError: If there is none.
    """
    if name in EVADERS:
        return EVADERS[name](angle)
    return _own(name, "evader", EVADERS)


def pursuer_of(name: str) -> Strategy:
    """Pursuer of a name, or of FILE.py:NAME; see :func:`evader_of`."""
    if name in PURSUERS:
        return PURSUERS[name]()
    return _own(name, "pursuer", PURSUERS)


def _own(name: str, what: str, names: Mapping[str, object]) -> Strategy:
    if ".py:" not in name:
        raise ConfigurationError(
            f"{what} must be one of {', '.join(names)} or FILE.py:NAME, "
            f"got {name!r:.60}"
        )
    return load_strategy(name)
