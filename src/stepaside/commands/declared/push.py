"""A push as people write it."""

import re
from math import isfinite
from typing import TYPE_CHECKING, Any

import click

from ..options import ANGLE

if TYPE_CHECKING:
    from ...world.push import Push

PUSH = re.compile(r"^(?P<impulse>[^@]+)@(?P<time>[^:]+):(?P<direction>.+)$")


class PushType(click.ParamType["Push"]):
    """A push: ``1.2@5:90deg`` is 1.2 N s at 5 s to the left."""

    name = "IMPULSE@TIME:DIRECTION"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> "Push":
        """Parse a push."""
        from ...errors import StepAsideError
        from ...world.push import Push

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
            return Push(numbers[0], numbers[1], direction)
        except StepAsideError as error:
            self.fail(str(error), param, ctx)
