"""A push as people write it."""

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
NOBODY = "none"  # what is given to have no pushes at all


class PushType(click.ParamType["Push | None"]):
    """A push: ``1.2@5:90deg`` is 1.2 N s at 5 s to the left.

    Who is pushed may stand before it, as in ``pursuer=1.2@5:90deg``; instead
    of a push, ``none`` is none.
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

        if value == NOBODY:
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
            who = parts["player"] or ""
            return Push(numbers[0], numbers[1], direction, player=who)
        except StepAsideError as error:
            self.fail(str(error), param, ctx)


def all_pushes(given: "Sequence[Push | None]") -> "tuple[Push, ...]":
    """Pushes of all options together, of which some may say ``none``."""
    return tuple(push for push in given if push is not None)


PUSHES = OptionDeclaration(
    "--push",
    "Push a torso, any number of times: 1.2@5:90deg is 1.2 N s at 5 s to the "
    "left, and pursuer=1.2@5:90deg the pursuer instead of the evader; none "
    "takes those of the configuration away.",
    "pushes",
    kind=PushType(),
    gather=all_pushes,
    extra={"multiple": True},
)
