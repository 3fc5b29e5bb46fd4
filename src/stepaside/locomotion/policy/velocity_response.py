"""Response of a walking policy: velocities it delivers for its commands."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...core.errors import PolicyError
from ...strategies.velocity_set import (
    STILL,
    AxisValues,
    BodyVelocity,
    VelocitySet,
)
from .contract import CommandRanges

AXES = ("forward", "lateral", "turn")
TOLERANCE = 1e-9  # of the share of an interval
SWEEPS = 12  # over the axes of the inverse; it converges before


class AxisResponse(NamedTuple):
    """Delivered velocities for commands along one axis.

    Attributes:
        commands: Commands, ascending, zero included. Shape (n,).
        delivered: Mean velocity for each of them.
        lag: Time by which the motion after a command at rest is behind that
            of its final velocity, in [s].
        halting: Motion along the axis from the command to stand until the
            body stands, at the greatest command, in [m] or [rad].
    """

    commands: tuple[float, ...]
    delivered: tuple[BodyVelocity, ...]
    lag: float = 0.0
    halting: float = 0.0


@dataclass(frozen=True)
class VelocityResponse:
    """Delivered velocities, as the sum of the responses of three axes.

    Attributes:
        axes: Response to commands ahead, to the left and of turning.
    """

    axes: tuple[AxisResponse, AxisResponse, AxisResponse]

    def __post_init__(self) -> None:
        """Check the tables.

        Raises:
            PolicyError: If a table is not ascending, or the axis does not
                follow its command.
        """
        for i, (name, axis) in enumerate(zip(AXES, self.axes, strict=True)):
            own = [row[i] for row in axis.delivered]
            if len(axis.commands) < 2 or 0.0 not in axis.commands:
                raise PolicyError(
                    f"response.{name} must contain a command of 0 and others"
                )
            for values in (axis.commands, own):
                if not (np.diff(values) > 0.0).all():
                    raise PolicyError(
                        f"response.{name} must ascend with the command, got "
                        f"{', '.join(f'{x:.3g}' for x in values)}"
                    )

    @classmethod
    def ideal(cls, ranges: CommandRanges) -> "VelocityResponse":
        """Return the response of legs that deliver every command exactly."""
        axes = []
        for name, limits in zip(AXES, ranges, strict=True):
            commands = tuple(sorted({*limits, 0.0}))
            rows = (STILL._replace(**{name: value}) for value in commands)
            axes.append(AxisResponse(commands, tuple(rows)))
        return cls((axes[0], axes[1], axes[2]))

    @cached_property
    def _effects(self) -> tuple[tuple[BodyVelocity, ...], ...]:
        """Delivered velocities of each axis beyond that of standing."""
        effects = []
        for axis in self.axes:
            rows = np.array(axis.delivered)
            rows = rows - rows[axis.commands.index(0.0)]
            effects.append(tuple(BodyVelocity(*row) for row in rows.tolist()))
        return tuple(effects)

    @cached_property
    def _own(self) -> tuple[tuple[float, ...], ...]:
        """Effect of each axis on its own component, ascending."""
        return tuple(
            tuple(row[i] for row in rows)
            for i, rows in enumerate(self._effects)
        )

    def _effect(self, axis: int, command: float) -> BodyVelocity:
        """Return the velocity that a command along one axis adds."""
        rows = self._effects[axis]
        i, share = _locate(self.axes[axis].commands, command)
        (a, b, c), (u, v, w) = rows[i], rows[i + 1]
        return BodyVelocity(
            a + share * (u - a), b + share * (v - b), c + share * (w - c)
        )

    def deliver(self, command: BodyVelocity) -> BodyVelocity:
        """Return the velocity that a command leads to."""
        effects = [self._effect(i, c) for i, c in enumerate(command)]
        return BodyVelocity(*np.sum(effects, axis=0).tolist())

    def command_for(self, velocity: BodyVelocity) -> BodyVelocity:
        """Return the command whose delivered velocity is nearest to one.

        Each axis in turn is solved for what the others leave; the cross terms
        of walking policies are small.
        """
        found = [(0, 0.0)] * 3
        effects: list[tuple[float, ...]] = [STILL, STILL, STILL]
        for _ in range(SWEEPS):
            changed = False
            for i, own in enumerate(self._own):
                others = effects[i - 1][i] + effects[i - 2][i]
                k, share = _locate(own, velocity[i] - others)
                changed |= k != found[i][0] or (
                    abs(share - found[i][1]) > TOLERANCE
                )
                found[i] = k, share
                rows = self._effects[i]
                (a, b, c), (u, v, w) = rows[k], rows[k + 1]
                effects[i] = (
                    a + share * (u - a),
                    b + share * (v - b),
                    c + share * (w - c),
                )
            if not changed:
                break
        command = (
            axis.commands[k]
            + share * (axis.commands[k + 1] - axis.commands[k])
            for axis, (k, share) in zip(self.axes, found, strict=True)
        )
        return BodyVelocity(*command)

    @cached_property
    def velocities(self) -> VelocitySet:
        """Velocities that are delivered, and how fast."""
        bounds = [(own[0], own[-1]) for own in self._own]
        lags = AxisValues(*(axis.lag for axis in self.axes))
        halting = AxisValues(*(axis.halting for axis in self.axes))
        return VelocitySet(bounds[0], bounds[1], bounds[2], lags, halting)


def _locate(values: Sequence[float], value: float) -> tuple[int, float]:
    """Return the interval of a value, and the share of it below the value.

    Args:
        values: Ascending values.
        value: A value; one outside counts as the nearest end.
    """
    i = min(max(bisect_right(values, value) - 1, 0), len(values) - 2)
    share = (value - values[i]) / (values[i + 1] - values[i])
    return i, min(1.0, max(0.0, share))
