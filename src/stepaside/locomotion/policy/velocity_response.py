"""Response of a walking policy: velocities it delivers for its commands."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.compilation import bound, compiled
from ...core.entries import load_entries, read_entries, to_entries
from ...core.errors import PolicyError, check_within
from ...core.poses import Array
from ...core.ranges import Range
from ...core.setting import REQUIRED, check_settings, setting
from ...strategies.body_departure import BodyDeparture
from ...strategies.velocity_set import (
    STILL,
    AxisValues,
    BodyVelocity,
    VelocitySet,
)
from .contract import CommandRanges

AXES = ("forward", "lateral", "turn")
TOLERANCE = 1e-9  # of the share of an interval
LARGEST = 100.0  # of each number, in its unit
NONE = "no legs are so fast"
SWEEPS = 12  # over the axes of the inverse; it converges before


@compiled
def invert(
    velocity: Array,
    sizes: NDArray[np.int_],
    commands: Array,
    effects: Array,
    found: Array,
    sums: Array,
    command: Array,
) -> None:
    """Set the command for a velocity; see :meth:`VelocityResponse.inverse`."""
    columns = commands.shape[1]
    for i in range(3):
        found[i] = -1.0
        sums[i, 0], sums[i, 1], sums[i, 2] = 0.0, 0.0, 0.0
    for _ in range(SWEEPS):
        change = 0.0
        for i in range(3):
            wanted = velocity[i]
            for j in range(3):
                wanted -= sums[j, i] if j != i else 0.0
            k = i * columns
            for m in range(i * columns, i * columns + sizes[i] - 1):
                k = m if effects[m, i] <= wanted else k
            low = effects[k, i]
            share = (wanted - low) / (effects[k + 1, i] - low)
            share = min(1.0, max(0.0, share))
            place = k + share
            change = max(change, abs(place - found[i]))
            found[i] = place
            for a in range(3):
                step = effects[k + 1, a] - effects[k, a]
                sums[i, a] = effects[k, a] + share * step
            first = commands[i, k - i * columns]
            step = commands[i, k - i * columns + 1] - first
            command[i] = first + share * step
        if change <= TOLERANCE:
            return


@dataclass(frozen=True)
class AxisResponse:
    """Delivered velocities for commands along one axis."""

    commands: tuple[float, ...] = setting(
        REQUIRED,
        "Commands, ascending, zero included",
        Range(-LARGEST, LARGEST, "m/s or rad/s", NONE),
    )
    delivered: tuple[BodyVelocity, ...] = setting(
        REQUIRED, "Mean velocity for each of them"
    )
    lag: float = setting(
        0.0,
        "Time by which the motion after a command at rest is behind that of "
        "its final velocity",
        Range(0.0, LARGEST, "s", NONE),
    )
    halting: float = setting(
        0.0,
        "Motion along the axis from the command to stand until the body "
        "stands, at the greatest command",
        Range(0.0, LARGEST, "m or rad", NONE),
    )

    def __post_init__(self) -> None:
        """Check the numbers, and that there is a row for each command."""
        check_settings(self, PolicyError)
        for value in chain(*self.delivered):
            check_within(
                *(value, -LARGEST, LARGEST),
                *("delivered", "m/s or rad/s", PolicyError),
            )
        if len(self.commands) < 2 or 0.0 not in self.commands:
            raise PolicyError(
                "commands must contain a command of 0 and others"
            )
        if len(self.delivered) != len(self.commands):
            raise PolicyError(
                f"delivered must have a row for each of the "
                f"{len(self.commands)} commands, got {len(self.delivered)}"
            )


@dataclass(frozen=True)
class VelocityResponse:
    """Delivered velocities, as the sum of the responses of three axes."""

    forward: AxisResponse = setting(REQUIRED, "Response to commands ahead")
    lateral: AxisResponse = setting(REQUIRED, "Response to commands aside")
    turn: AxisResponse = setting(REQUIRED, "Response to turning commands")
    tube: float = setting(
        0.0,
        "Greatest distance of the body from its template point {unit}; 0 if "
        "it was not measured",
        Range(0.0, LARGEST, "m", NONE),
    )
    reach: float = setting(
        0.0,
        "Radius around the torso that contains the walking body {unit}; 0 "
        "likewise",
        Range(0.0, LARGEST, "m", NONE),
    )
    loss: float = setting(
        0.0,
        "Greatest error of the leg odometry between two decisions",
        Range(0.0, LARGEST, "m", NONE),
    )
    drift: float = setting(
        0.0,
        "By which it grows with each further decision",
        Range(0.0, LARGEST, "m", NONE),
    )
    odometry_ratio: tuple[float, float] = setting(
        (1.0, 1.0),
        "True motion by that of the leg odometry, ahead and to the side",
        Range(0.0, LARGEST, "1", NONE, above=True),
    )
    network: str = setting("", "Digest of the network, in its file")

    def __post_init__(self) -> None:
        """Check the numbers, and that velocities ascend with the command."""
        check_settings(self, PolicyError)
        for i, (name, axis) in enumerate(zip(AXES, self.axes, strict=True)):
            own = [row[i] for row in axis.delivered]
            for key, values in ("commands", axis.commands), ("delivered", own):
                if not (np.diff(values) > 0.0).all():
                    raise PolicyError(
                        f"{name}.{key} must ascend with the command, got "
                        f"{', '.join(f'{x:.3g}' for x in values)}"
                    )

    @property
    def axes(self) -> tuple[AxisResponse, AxisResponse, AxisResponse]:
        """Responses ahead, to the left and of turning."""
        return self.forward, self.lateral, self.turn

    @classmethod
    def ideal(cls, ranges: CommandRanges) -> "VelocityResponse":
        """Return the response of legs that deliver every command exactly."""
        axes = []
        for name, limits in zip(AXES, ranges, strict=True):
            commands = tuple(sorted({*limits, 0.0}))
            rows = (STILL._replace(**{name: value}) for value in commands)
            axes.append(AxisResponse(commands, tuple(rows)))
        return cls(axes[0], axes[1], axes[2])

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

    def deliver(self, command: BodyVelocity) -> BodyVelocity:
        """Return the velocity that a command leads to."""
        effects = [
            [
                np.interp(own, axis.commands, column)
                for column in np.transpose(rows)
            ]
            for own, axis, rows in zip(
                command, self.axes, self._effects, strict=True
            )
        ]
        return BodyVelocity(*np.sum(effects, axis=0).tolist())

    @property
    def tables(self) -> tuple[NDArray[np.int_], Array, Array]:
        """Number of commands of each axis, the commands, and their effects.

        Shapes (3,), (3, n) and (3 n, 3); arguments of :func:`invert`.
        """
        sizes = np.array([len(axis.commands) for axis in self.axes])
        commands = np.zeros((3, sizes.max()))
        effects = np.zeros((3, sizes.max(), 3))
        for i, axis in enumerate(self.axes):
            commands[i, : sizes[i]] = axis.commands
            effects[i, : sizes[i]] = self._effects[i]
        return sizes, commands, effects.reshape(-1, 3)

    def inverse(self, velocity: Array, command: Array) -> Callable[[], None]:
        """Return the loop that sets the command (3,) for a velocity (3,).

        The velocity that it delivers is nearest. Each axis in turn is solved
        for what the others leave; the cross terms of walking policies are
        small.
        """
        return bound(
            *(invert, velocity, *self.tables),
            *(np.zeros(3), np.zeros((3, 3)), command),
        )

    @property
    def departure(self) -> BodyDeparture | None:
        """Departure of the body from its template; None if not measured."""
        if self.reach == 0.0:
            return None
        return BodyDeparture(self.reach, self.tube, self.loss, self.drift)

    @cached_property
    def velocities(self) -> VelocitySet:
        """Velocities that are delivered, and how fast."""
        bounds = [(own[0], own[-1]) for own in self._own]
        lags = AxisValues(*(axis.lag for axis in self.axes))
        halting = AxisValues(*(axis.halting for axis in self.axes))
        return VelocitySet(
            bounds[0], bounds[1], bounds[2], lags, halting, self.tube
        )


def response_path(folder: Path, network: Path) -> Path:
    """Return the file of the response of a network on a robot."""
    return folder / f"legs-{network.stem}.toml"


def digest_of(network: Path) -> str:
    """Return the SHA-256 digest of a network, to tell networks apart.

    Weights in a file beside it, as PyTorch writes them, belong to it.
    """
    weights = network.with_name(f"{network.name}.data")
    content = network.read_bytes()
    if weights.exists():
        content += weights.read_bytes()
    return hashlib.sha256(content).hexdigest()


def response_entries(
    response: VelocityResponse, network: Path
) -> dict[str, Any]:
    """Return a response as entries of its file."""
    entries: dict[str, Any] = to_entries(response)
    for name, axis in zip(AXES, response.axes, strict=True):
        entries[name]["delivered"] = [list(row) for row in axis.delivered]
    return entries | {"network": digest_of(network)}


def load_response(folder: Path, network: Path) -> VelocityResponse | None:
    """Load the measured response of this very network, if there is one."""
    path = response_path(folder, network)
    if not path.is_file():
        return None
    try:
        entries = load_entries(path, PolicyError)
        own = read_entries(VelocityResponse, entries, error=PolicyError)
    except PolicyError as error:
        raise PolicyError(
            f"{path} is not a response of legs: {error}; `stepaside robot "
            "legs measure` writes it anew"
        ) from error
    return own if own.network == digest_of(network) else None
