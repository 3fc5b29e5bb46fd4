"""Entrants of a tournament: strategies by name."""

import re
from collections.abc import Callable, Iterable, Mapping
from math import pi, radians

from ..core.errors import ConfigurationError, check_within
from ..strategies import (
    Evasion,
    LookAhead,
    OptimalEvasion,
    RobustEvasion,
    Strategy,
    load_strategy,
)
from ..strategies.registry import file_of

SIGHT = radians(148.0)  # greatest bearing in view of a turned head, in [rad]
ALWAYS = 1e6  # safety radius that always triggers evasion, in [m]

EVADERS: Mapping[str, Callable[[float], Strategy]] = {
    "look-ahead": lambda angle: LookAhead(),
    "aside": lambda angle: Evasion(safety_radius=ALWAYS),
    "saturated": lambda angle: Evasion(saturated=True, safety_radius=ALWAYS),
    "alpha": lambda angle: Evasion(angle, safety_radius=ALWAYS),
    "optimal": lambda angle: OptimalEvasion(),
    "robust": lambda angle: RobustEvasion(),
}
"""Factories of the evaders, which take the angle of "alpha" in [rad]."""
PURSUERS: Mapping[str, str] = {
    "pure": "pursuit",
    "sharp": "sharp",
    "herding": "herding",
    "lead": "lead",
    "noisy": "noisy",
    "stop-and-wait": "stop-and-wait",
    "optimal": "optimal-pursuit",
}
"""Name of the strategy of each pursuer."""
_WITH_GAIN = re.compile(r"pure-x(?P<ratio>\d+(?:\.\d*)?)", re.ASCII)
"""The paper's pursuer with RATIO times the evader's gain."""
_WITH_SPEED = re.compile(r"(?P<rest>.+)-v(?P<ratio>\d+(?:\.\d*)?)", re.ASCII)
"""Any pursuer with RATIO times the evader's speed."""


def evader_of(name: str, angle: float = pi / 2) -> Strategy:
    """Return the evader of a name, FILE.py:NAME or FILE.onnx.

    Raises:
        ConfigurationError: If there is none.
    """
    if name in EVADERS:
        return EVADERS[name](angle)
    return _own(name, "evader", EVADERS)


def pursuer_of(name: str) -> Strategy:
    """Return the pursuer of a name, pure-xRATIO, or of a file.

    The suffix -vRATIO of :func:`speed_ratio_of` is left out.

    Raises:
        ConfigurationError: If there is none.
    """
    if found := _WITH_SPEED.fullmatch(name):
        ratio = float(found["ratio"])
        check_within(
            ratio, 0.1, 10.0, "RATIO of -vRATIO", "1", ConfigurationError
        )
        name = found["rest"]
    if name in PURSUERS or _WITH_GAIN.fullmatch(name):
        return load_strategy(pursuer_strategy(name))
    return _own(name, "pursuer", (*PURSUERS, "pure-xRATIO, any-vRATIO"))


def speed_ratio_of(name: str) -> float:
    """Return the speed of a pursuer over the evader's; 1 without -vRATIO."""
    found = _WITH_SPEED.fullmatch(name)
    return float(found["ratio"]) if found else 1.0


def pursuer_strategy(name: str) -> str:
    """Return the name of a pursuer for ``strategies.load_strategy``."""
    found = _WITH_GAIN.fullmatch(name)
    return f"pursuit-x{found['ratio']}" if found else PURSUERS.get(name, name)


def gain_ratio_of(name: str) -> float | None:
    """Return the gain of a pursuer by the evader's; None if not by eq. (2)."""
    found = _WITH_GAIN.fullmatch(name)
    return float(found["ratio"]) if found else {"pure": 1.0}.get(name)


def _own(name: str, what: str, names: Iterable[str]) -> Strategy:
    if file_of(name) is None:
        raise ConfigurationError(
            f"{what} must be one of {', '.join(names)}, FILE.py:NAME or "
            f"FILE.onnx, got {name!r:.60}"
        )
    return load_strategy(name)
