"""Strategies on the command line, which games of all levels share."""

from typing import Any

import click

from .declaration import OptionDeclaration


class StrategyType(click.ParamType[str]):
    """A strategy: a name of the registry, or FILE.py:NAME."""

    name = "NAME|FILE.py:NAME"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> str:
        """Check the form; a file is opened when it is to play."""
        from ...core.errors import ConfigurationError
        from ...strategies.registry import absolute_name, check_strategy_name

        try:
            check_strategy_name(str(value))
        except ConfigurationError as error:
            self.fail(str(error), param, ctx)
        return absolute_name(str(value))


NAMED = (
    "its name (evasion, deflected, look-ahead, optimal, pursuit, "
    "pursuit-xRATIO, sharp, herding, lead, optimal-pursuit, stand, walk), or "
    "FILE.py:NAME"
)


OF_EVADER = f"Of the evader: {NAMED} for one of your own; evasion by default."
EVADER_STRATEGY = OptionDeclaration(
    "--strategy",
    OF_EVADER,
    "evader_strategy",
    kind=StrategyType(),
    tells_default=False,
    more_names=("--evader-strategy",),
)
# Games of unicycles know --strategy for the angle by name.
UNICYCLE_STRATEGY = OptionDeclaration(
    "--evader-strategy",
    OF_EVADER,
    kind=StrategyType(),
    tells_default=False,
    more_names=("evader_strategy",),
)
PURSUER_STRATEGY = OptionDeclaration(
    "--pursuer-strategy",
    f"Of a pursuer that is a robot: {NAMED}; pursuit by default.",
    "pursuer_strategy",
    kind=StrategyType(),
    tells_default=False,
)
