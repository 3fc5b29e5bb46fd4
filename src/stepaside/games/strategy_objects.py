"""Strategies that settings are given as Python objects."""

from dataclasses import fields
from typing import Any

from ..core.errors import ConfigurationError, shown
from ..strategies import STRATEGIES, Evasion, Strategy
from ..strategies.registry import OF_EVASION

EVASION = "evasion"


def settled(strategy: Any, evader: Any, pursuer: Any) -> dict[str, Any]:
    """Return entries of a duel in which names stand wherever they can.

    An object that equals a strategy of the registry becomes its name. One of
    the evader that was given as ``strategy``, like a subclass of
    :class:`~stepaside.strategies.Evasion`, becomes what the evader plays.

    Args:
        strategy: How an evader of the paper evades, or an own strategy.
        evader: What the evader plays: a name or a strategy.
        pursuer: What a pursuing robot plays, likewise.

    Raises:
        ConfigurationError: If one is no strategy, or they contradict each
            other.
    """
    for name, value in (
        ("strategy", strategy),
        ("evader_strategy", evader),
        ("pursuer_strategy", pursuer),
    ):
        _check(name, value)
    if type(strategy) is not Evasion:
        if evader != EVASION:
            raise ConfigurationError(
                "strategy must be an Evasion beside evader_strategy "
                f"{shown(evader)}, got a {type(strategy).__name__}"
            )
        strategy, evader = _base(strategy), strategy
    if not isinstance(evader, str):
        inner = evader if type(evader) is Evasion else strategy
        inner = getattr(evader, "evasion", inner)
        if type(inner) is Evasion and _name(evader, inner) in OF_EVASION:
            if strategy not in (Evasion(), inner):
                raise ConfigurationError(
                    "strategy must be left out beside an evader_strategy "
                    f"that holds another, got {shown(strategy)}"
                )
            strategy = inner
        evader = _name(evader, strategy) or evader
    if not isinstance(pursuer, str):
        pursuer = _name(pursuer, strategy) or pursuer
    return {
        "strategy": strategy,
        "evader_strategy": evader,
        "pursuer_strategy": pursuer,
    }


def check_named(settings: Any) -> None:
    """Refuse strategy objects where records are kept.

    Args:
        settings: Of a duel.

    Raises:
        ConfigurationError: If a strategy has no name: records do not tell
            one object from another of its class.
    """
    for name in ("evader_strategy", "pursuer_strategy"):
        played = getattr(settings, name)
        if not isinstance(played, str):
            raise ConfigurationError(
                f"{name} must be a name or FILE.py:NAME where records are "
                f"kept, got a Python object, {type(played).__name__}"
            )


def _check(name: str, value: Any) -> None:
    """Refuse what is neither a name nor like a strategy."""
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
    """What a subclass of the paper's evader has of it; else the default."""
    if not isinstance(strategy, Evasion):
        return Evasion()
    values = {f.name: getattr(strategy, f.name) for f in fields(Evasion)}
    return Evasion(**values)


def _name(played: Strategy, evasion: Evasion) -> str | None:
    """Name in the registry of what plays the same; None if there is none."""
    for name, make in STRATEGIES.items():
        made = make(evasion)
        if type(made) is type(played) and made == played:
            return name
    return None
