"""Response of a walking policy: velocities it delivers for its commands."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...core.errors import PolicyError
from ...core.poses import Array
from .contract import CommandRanges

AXES = ("forward", "lateral", "turn")
SWEEPS = 12  # over the axes of the inverse, which converges in about four


class BodyVelocity(NamedTuple):
    """Velocity of a body in its own frame, over the floor.

    Attributes:
        forward: Ahead, in [m/s].
        lateral: To the left, in [m/s].
        turn: Turning rate, in [rad/s], positive to the left.
    """

    forward: float = 0.0
    lateral: float = 0.0
    turn: float = 0.0


STILL = BodyVelocity()


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
        odometry_scale: True motion by that of the leg odometry; None if it
            was not measured. Feet roll, which the odometry does not contain.
    """

    axes: tuple[AxisResponse, AxisResponse, AxisResponse]
    odometry_scale: float | None = None

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
    def _tables(self) -> list[tuple[Array, Array]]:
        """Commands of each axis, and their effect beyond that of standing."""
        tables = []
        for axis in self.axes:
            commands = np.array(axis.commands)
            rows = np.array(axis.delivered)
            rest = rows[axis.commands.index(0.0)]
            tables.append((commands, rows - rest))
        return tables

    def _effect(self, axis: int, command: float) -> Array:
        commands, rows = self._tables[axis]
        return np.array(
            [np.interp(command, commands, rows[:, k]) for k in range(3)]
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
        command = [0.0, 0.0, 0.0]
        for _ in range(SWEEPS):
            for i in range(3):
                others = [j for j in range(3) if j != i]
                cross = sum(self._effect(j, command[j])[i] for j in others)
                commands, rows = self._tables[i]
                missing = velocity[i] - cross
                command[i] = float(np.interp(missing, rows[:, i], commands))
        return BodyVelocity(*command)

    def nearest(self, velocity: BodyVelocity) -> BodyVelocity:
        """Return the deliverable velocity with the curvature of another.

        Forward, lateral and turning velocity are scaled alike, so that the
        path stays the same and takes longer.
        """
        share = 1.0
        for value, (low, high) in zip(velocity, self.limits, strict=True):
            limit = high if value > 0.0 else -low
            if abs(value) > limit:
                share = min(share, limit / abs(value))
        return BodyVelocity(*(share * value for value in velocity))

    @property
    def limits(self) -> CommandRanges:
        """Least and greatest velocity delivered along each axis alone."""
        ends = [
            (float(rows[0, i]), float(rows[-1, i]))
            for i, (_, rows) in enumerate(self._tables)
        ]
        return CommandRanges(*ends)
