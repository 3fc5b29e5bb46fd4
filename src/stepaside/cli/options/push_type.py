"""Syntax of a push on the command line."""

import re
from collections.abc import Sequence
from math import isfinite
from typing import TYPE_CHECKING, Any

import click

from ..value_types import ANGLE
from .declaration import OptionDeclaration

if TYPE_CHECKING:
    from ...sim.push import Push

PUSH = re.compile(
    r"^(?:(?P<player>[a-z]+)=)?(?P<impulse>[^@=]+)@(?P<time>[^:]+):"
    r"(?P<direction>.+)$"
)
NO_VALUE = "none"  # removes the values of the configuration


class PushType(click.ParamType["Push | None"]):
    """Push: ``1.2@5:90deg`` is 1.2 N s at 5 s to the left, or ``none``.

    The player may precede it, as in ``pursuer=1.2@5:90deg``.
    """

    name = "[PLAYER=]IMPULSE@TIME:DIRECTION"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> "Push | None":
        """Parse a push."""
        from ...core.errors import StepAsideError
        from ...sim.push import Push

        if value == NO_VALUE:
            return None
        parts = PUSH.match(str(value))
        if parts is None:
            self.fail(
                "must be IMPULSE@TIME:DIRECTION [N s, s, angle] like "
                f"1.2@5:90deg, got {value!r}",
                param,
                ctx,
            )
        direction = ANGLE.convert(parts["direction"], param, ctx)
        numbers = []
        for name, unit in (("impulse", "N s"), ("time", "s")):
            try:
                number = float(parts[name])
            except ValueError:
                number = float("nan")
            if not isfinite(number):
                self.fail(
                    f"{name} must be a finite number [{unit}], "
                    f"got {parts[name]!r}",
                    param,
                    ctx,
                )
            numbers.append(number)
        try:
            player = parts["player"] or ""
            return Push(numbers[0], numbers[1], direction, player=player)
        except StepAsideError as error:
            self.fail(str(error), param, ctx)


def all_pushes(given: "Sequence[Push | None]") -> "tuple[Push, ...]":
    """Return the pushes of all options, without ``none``."""
    return tuple(push for push in given if push is not None)


PUSHES = OptionDeclaration(
    "--push",
    "Push the torso of the evader; repeatable. 1.2@5:90deg is 1.2 N s at 5 s "
    "to the left; pursuer=1.2@5:90deg pushes the pursuer. none removes those "
    "of the configuration.",
    "pushes",
    kind=PushType(),
    collect=all_pushes,
    extra={"multiple": True},
)
