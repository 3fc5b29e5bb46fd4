"""Strategies given to settings as Python objects."""

from dataclasses import fields
from typing import Any, NamedTuple

from ..core.errors import ConfigurationError, shown
from ..strategies import STRATEGIES, Evasion, Strategy, load_strategy
from .implied_settings import EVASION


class DuelStrategies(NamedTuple):
    """Strategies of a duel, as its settings hold them.

    Attributes:
        strategy: Settings of the evasion of the paper.
        evader_strategy: Name of the evader's strategy, or an object; empty
            if open.
        pursuer_strategy: Name of the pursuer's strategy, or an object.
    """

    strategy: Evasion
    evader_strategy: str | Strategy
    pursuer_strategy: str | Strategy


def resolve_strategies(
    strategy: Any, evader: Any, pursuer: Any
) -> DuelStrategies:
    """Replace strategy objects of a duel by names where possible.

    An object that equals a strategy of the registry is replaced by its name.
    An object that was given as ``strategy``, like a subclass of
    :class:`~stepaside.strategies.Evasion`, becomes the evader's strategy.

    Raises:
        ConfigurationError: If a value is not a strategy, or values
            contradict each other.
    """
    for name, value in (
        ("strategy", strategy),
        ("evader_strategy", evader),
        ("pursuer_strategy", pursuer),
    ):
        _check(name, value)
    if type(strategy) is not Evasion:
        if evader not in ("", EVASION):
            raise ConfigurationError(
                "strategy must be an Evasion with evader_strategy "
                f"{shown(evader)}, got a {type(strategy).__name__}"
            )
        strategy, evader = _base(strategy), strategy
    if type(evader) is Evasion:
        if strategy not in (Evasion(), evader):
            raise ConfigurationError(
                "strategy must be omitted with an evader_strategy that "
                f"contains another, got {shown(strategy)}"
            )
        strategy = evader
    if not isinstance(evader, str):
        evader = _name(evader, strategy) or evader
    if not isinstance(pursuer, str):
        pursuer = _name(pursuer, strategy) or pursuer
    return DuelStrategies(strategy, evader, pursuer)


def _check(name: str, value: Any) -> None:
    """Check that a value is a name or has the methods of a strategy."""
    if isinstance(value, str) and name != "strategy":
        return
    if isinstance(value, type):
        raise ConfigurationError(
            f"{name} must be a strategy, not its class: {value.__name__}(), "
            f"got {value.__name__}"
        )
    if not (hasattr(value, "begin") and hasattr(value, "decide")):
        rule = "text, or a strategy" if name != "strategy" else "an Evasion"
        raise ConfigurationError(f"{name} must be {rule}, got {shown(value)}")


def _base(strategy: Any) -> Evasion:
    """Return the settings of the paper's evasion that an object inherits."""
    if not isinstance(strategy, Evasion):
        return Evasion()
    values = {f.name: getattr(strategy, f.name) for f in fields(Evasion)}
    return Evasion(**values)


def _name(played: Strategy, evasion: Evasion) -> str | None:
    """Return the name in the registry of an equal strategy, or None."""
    for name in STRATEGIES:
        made = load_strategy(name, evasion)
        if type(made) is type(played) and made == played:
            return name
    return None
