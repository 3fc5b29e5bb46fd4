"""Syntax of a passing pedestrian on the command line."""

import re
from collections.abc import Sequence
from dataclasses import replace
from math import isfinite
from typing import TYPE_CHECKING, Any

import click

from ..value_types import ANGLE
from .declaration import OptionDeclaration
from .push_type import NO_VALUE

if TYPE_CHECKING:
    from ...sim.passerby_settings import Passer

PASSER = re.compile(
    r"^(?P<speed>[^@]+)@(?P<distance>[^:]+):(?P<bearing>[^:]+)"
    r"(?::(?P<miss>.+))?$"
)


class PasserType(click.ParamType["Passer | None"]):
    """Passing pedestrian: ``0.8@3:90deg:1.5``, or ``none``.

    The example walks at 0.8 m/s, starts 3 m to the left of the evader, and
    passes it at a lateral offset of 1.5 m.
    """

    name = "SPEED@DISTANCE:BEARING[:MISS]"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> "Passer | None":
        """Parse a pedestrian."""
        from ...core.errors import StepAsideError
        from ...sim.passerby_settings import Passer

        if value == NO_VALUE:
            return None
        parts = PASSER.match(str(value))
        if parts is None:
            self.fail(
                "must be SPEED@DISTANCE:BEARING[:MISS] [m/s, m, angle, m] "
                f"like 0.8@3:90deg:1.5, got {value!r}",
                param,
                ctx,
            )
        numbers = {}
        for name, unit in (("speed", "m/s"), ("distance", "m"), ("miss", "m")):
            if parts[name] is None:
                continue
            try:
                numbers[name] = float(parts[name])
            except ValueError:
                numbers[name] = float("nan")
            if not isfinite(numbers[name]):
                self.fail(
                    f"{name} must be a finite number [{unit}], "
                    f"got {parts[name]!r}",
                    param,
                    ctx,
                )
        bearing = ANGLE.convert(parts["bearing"], param, ctx)
        try:
            passer = Passer(numbers["speed"], numbers["distance"], bearing)
            if "miss" in numbers:
                return replace(passer, miss=numbers["miss"])
            return passer
        except StepAsideError as error:
            self.fail(str(error), param, ctx)


def all_passers(given: "Sequence[Passer | None]") -> "tuple[Passer, ...]":
    """Return the pedestrians of all options, without ``none``."""
    return tuple(passer for passer in given if passer is not None)


PASSERS = OptionDeclaration(
    "--passer",
    "Add a passing pedestrian; repeatable. 0.8@3:90deg:1.5 walks at 0.8 m/s, "
    "starts 3 m to the left of the evader and passes it at a lateral offset "
    "of 1.5 m. none removes those of the configuration.",
    "passers",
    kind=PasserType(),
    collect=all_passers,
    extra={"multiple": True},
)
