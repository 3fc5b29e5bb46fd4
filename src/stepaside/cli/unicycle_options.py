"""Options for the parameters of a game of unicycles."""

from collections.abc import Callable
from functools import wraps
from math import pi
from typing import Any

import click

from ..theory.unicycle.unicycle_game import (
    Game,
    SideRule,
    TurningLaw,
    make_game,
)
from .options.declaration import OptionDeclaration
from .options.value_kinds import NameType
from .value_types import NumberType

STRATEGIES = {"move-aside": pi / 2, "move-back": 0.0}


def _number(name: str, help_text: str, unit: str) -> OptionDeclaration:
    return OptionDeclaration(name, help_text, unit=unit, kind=NumberType(unit))


_OPTIONS = [
    _number("--speed", "Speed v of both players", "m/s").option(
        default=1.0, show_default=True
    ),
    _number("--gain", "Steering gain k of both players", "1/s").option(
        default=0.5, show_default=True
    ),
    _number(
        "--pursuer-speed", "Speed of the pursuer, if different", "m/s"
    ).option(),
    _number(
        "--evader-speed", "Speed of the evader, if different", "m/s"
    ).option(),
    _number(
        "--pursuer-gain", "Steering gain of the pursuer, if different", "1/s"
    ).option(),
    _number(
        "--evader-gain", "Steering gain of the evader, if different", "1/s"
    ).option(),
    OptionDeclaration(
        "--angle",
        "Evasion angle {unit}, like 1.2, 1.2rad or 70deg.  [default: 90deg]",
        unit="rad",
    ).option(),
    OptionDeclaration(
        "--strategy",
        "Evasion angle by name: move-aside (90deg) or move-back (0).",
        kind=NameType(lambda: tuple(STRATEGIES)),
    ).option(),
    OptionDeclaration(
        "--law",
        "Turning law of the evader: eq. (4) or eq. (6).",
        kind=NameType(lambda: [law.value for law in TurningLaw]),
    ).option(default=TurningLaw.PROPORTIONAL.value, show_default=True),
    OptionDeclaration(
        "--side-rule",
        "Side of the line of sight to which the evader moves: the side "
        "behind it at every instant (behind), or its initial side (latched).",
        kind=NameType(lambda: [rule.value for rule in SideRule]),
    ).option(default=SideRule.BEHIND.value, show_default=True),
    OptionDeclaration(
        "--hysteresis",
        "Angle beyond the evader's axis at which it changes side, with "
        "--side-rule behind",
        unit="rad",
        aliases=("--side-hysteresis", "hysteresis"),
    ).option(default=0.0, show_default=True),
]


def game_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options to a command; pass it ``game``."""

    @wraps(function)
    def command(**values: Any) -> Any:
        game = _take_game(values)
        return function(game=game, **values)

    taken: Callable[..., Any] = command
    for option in reversed(_OPTIONS):
        taken = option(taken)
    return taken


def _take_game(values: dict[str, Any]) -> Game:
    """Remove the game's options from a command's values; return the game."""
    speed, gain = values.pop("speed"), values.pop("gain")
    angle, strategy = values.pop("angle"), values.pop("strategy")
    if angle is not None and strategy is not None:
        raise click.UsageError("--angle and --strategy cannot be combined")
    if angle is None:
        angle = STRATEGIES[strategy or "move-aside"]
    if not 0.0 <= angle <= pi:
        raise click.BadParameter(
            f"must lie in [0, pi] [rad], got {angle}", param_hint="--angle"
        )
    hysteresis = values.pop("hysteresis")
    largest = min(angle, pi - angle)
    if not 0.0 <= hysteresis <= largest:
        raise click.BadParameter(
            f"must lie in [0, {largest:g}] [rad], got {hysteresis}",
            param_hint="--hysteresis",
        )
    return make_game(
        _first(values.pop("pursuer_speed"), speed),
        _first(values.pop("evader_speed"), speed),
        _first(values.pop("pursuer_gain"), gain),
        _first(values.pop("evader_gain"), gain),
        angle,
        values.pop("law"),
        side_rule=values.pop("side_rule"),
        hysteresis=hysteresis,
    )


def _first(value: float | None, otherwise: float) -> float:
    return otherwise if value is None else value


def describe_game(game: Game) -> dict[str, float | str]:
    """Return the parameters of a game, for JSON."""
    return {
        "pursuer_speed_m_s": game.pursuer.speed,
        "evader_speed_m_s": game.evader.speed,
        "pursuer_gain_per_s": game.pursuer.gain,
        "evader_gain_per_s": game.evader.gain,
        "angle_rad": game.angle,
        "law": game.law.value,
        "side_rule": game.side_rule.value,
        "hysteresis_rad": game.hysteresis,
    }


def finite(value: float) -> float | None:
    """Return a value for JSON: None for NaN and infinity."""
    return value if abs(value) < float("inf") else None
