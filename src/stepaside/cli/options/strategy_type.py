"""Options that choose strategies, for games of all levels."""

from typing import Any

import click

from .declaration import OptionDeclaration


class StrategyType(click.ParamType[str]):
    """Strategy: a name of the registry, or FILE.py:NAME."""

    name = "NAME|FILE.py:NAME"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> str:
        """Check the syntax; a file is loaded when its strategy is used."""
        from ...core.errors import ConfigurationError
        from ...strategies.registry import absolute_name, check_strategy_name

        try:
            check_strategy_name(str(value))
        except ConfigurationError as error:
            self.fail(str(error), param, ctx)
        return absolute_name(str(value))


NAMES = (
    "evasion, deflected, look-ahead, optimal, pursuit, pursuit-xRATIO, sharp, "
    "herding, lead, optimal-pursuit, stand, walk, or FILE.py:NAME for your "
    "own"
)
OF_EVADER = f"Strategy of the evader: {NAMES}.  [default: evasion]"
EVADER_STRATEGY = OptionDeclaration(
    "--strategy",
    OF_EVADER,
    "evader_strategy",
    kind=StrategyType(),
    shows_default=False,
    aliases=("--evader-strategy",),
)
# In unicycle games, --strategy chooses the evasion angle.
UNICYCLE_STRATEGY = OptionDeclaration(
    "--evader-strategy",
    OF_EVADER,
    kind=StrategyType(),
    shows_default=False,
    aliases=("evader_strategy",),
)
PURSUER_STRATEGY = OptionDeclaration(
    "--pursuer-strategy",
    f"Strategy of a robot pursuer: {NAMES}.  [default: pursuit]",
    "pursuer_strategy",
    kind=StrategyType(),
    shows_default=False,
)
