"""Options for the parameters of a game of unicycles."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from math import pi
from typing import Any

import click

from ..core.errors import ConfigurationError, check_within
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from ..theory.unicycle.unicycle_game import (
    Game,
    SideRule,
    TurningLaw,
    make_game,
)
from .options.parameter_types import positive
from .options.settings_options import refuse_options, takes

STRATEGIES = {"move-aside": pi / 2, "move-back": 0.0}
SPEED = positive("m/s", None)
GAIN = positive("1/s", None)


@dataclass(frozen=True, slots=True)
class UnicycleOptions:
    """Parameters of a game of unicycles, as options."""

    speed: float = setting(
        1.0,
        "Speed v of both players",
        positive("m/s"),
    )
    gain: float = setting(
        0.5,
        "Steering gain k of both players",
        positive("1/s"),
    )
    pursuer_speed: float | None = setting(
        None,
        "Speed of the pursuer, if different",
        SPEED,
    )
    evader_speed: float | None = setting(
        None,
        "Speed of the evader, if different",
        SPEED,
    )
    pursuer_gain: float | None = setting(
        None,
        "Steering gain of the pursuer, if different",
        GAIN,
    )
    evader_gain: float | None = setting(
        None,
        "Steering gain of the evader, if different",
        GAIN,
    )
    angle: float | None = setting(
        None,
        "Evasion angle {unit}, like 1.2, 1.2rad or 70deg",
        Range(0.0, pi, "rad", "the sign is given by the side", also=(None,)),
        default_text="90deg",
    )
    strategy: str | None = setting(
        None,
        "Evasion angle by name: move-aside (90deg) or move-back (0)",
        names=tuple(STRATEGIES),
    )
    law: str = setting(
        TurningLaw.PROPORTIONAL.value,
        "Turning law of the evader: eq. (4) or eq. (6)",
        names=[law.value for law in TurningLaw],
    )
    side_rule: str = setting(
        SideRule.BEHIND.value,
        "Side of the line of sight to which the evader moves: the side "
        "behind it at every instant (behind), or its initial side (latched)",
        names=[rule.value for rule in SideRule],
    )
    hysteresis: float = setting(
        0.0,
        "Angle beyond the evader's axis at which it changes side {unit}, "
        "with --side-rule behind",
        Range(0.0, pi / 2, "rad", "beyond, it never changes side"),
    )

    def __post_init__(self) -> None:
        """Validate ranges and names."""
        check_settings(self)

    def game(self) -> Game:
        """Return the game."""
        angle = self.angle
        if angle is None:
            angle = STRATEGIES[self.strategy or "move-aside"]
        elif self.strategy is not None:
            raise click.UsageError("--angle and --strategy cannot be combined")
        if self.side_rule != SideRule.BEHIND.value:
            refuse_options({"hysteresis"}, "--side-rule behind, got latched")
        check_within(
            self.hysteresis,
            0.0,
            min(angle, pi - angle),
            "hysteresis",
            "rad",
            ConfigurationError,
        )
        return make_game(
            _first(self.pursuer_speed, self.speed),
            _first(self.evader_speed, self.speed),
            _first(self.pursuer_gain, self.gain),
            _first(self.evader_gain, self.gain),
            angle,
            self.law,
            side_rule=self.side_rule,
            hysteresis=self.hysteresis,
        )


def game_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options to a command; pass it ``game``."""

    @wraps(function)
    def command(options: UnicycleOptions, **values: Any) -> Any:
        return function(game=options.game(), **values)

    return takes(UnicycleOptions, "options")(command)


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
