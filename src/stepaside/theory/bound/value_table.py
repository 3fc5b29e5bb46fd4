"""Table of a solved game: value, barrier and optimal turning rates."""

from dataclasses import asdict, dataclass
from functools import cached_property
from json import dumps, loads
from math import pi
from zipfile import BadZipFile

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.atomic_output import atomic_draft
from ...core.brief_repr import brief_repr
from ...core.errors import AnyPath, PlanError, as_path, check_within
from ...core.poses import wrap_angles
from ..unicycle.relative_coordinates import check_bearings
from .relative_game import BoundGame
from .state_grid import Grid, Values

Array = NDArray[np.float64]
FORMAT = 2  # of the files
FLAT = 1e-3  # slope that counts as zero, in game units per radian


@dataclass(frozen=True)
class Bound:
    r"""Optimal closest approach over relative states.

    Tables have the layout of :class:`.state_grid.Grid`, (a > 0, r, psi); the
    other half follows by :math:`V(r, -a, -\psi) = V(r, a, \psi)`.

    Attributes:
        game: The game that was solved.
        grid: The grid of the solution.
        values: Closest approach of the optimal evader, in [m]. Shape
            ``grid.shape``.
        horizon: Duration of the game, in [s].
        falling_mean: Mean decrease of the value over the last tenth of the
            horizon, in [m].
        falling_worst: Largest decrease over the last tenth, in [m].
        seconds: Computing time of the solution, in [s].
    """

    game: BoundGame
    grid: Grid
    values: Values
    horizon: float
    falling_mean: float
    falling_worst: float
    seconds: float

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        """Freeze the table."""
        self.values.flags.writeable = False

    def value(
        self, distance: ArrayLike, error: ArrayLike, bearing: ArrayLike
    ) -> Array:
        """Interpolate the optimal closest approach linearly.

        Args:
            distance: Distance r, in [m]. Below the grid the value is the
                distance; beyond the grid it increases with the distance.
            error: Bearing of the evader in the pursuer's frame, in [rad].
            bearing: Bearing of the pursuer in the evader's frame, in [rad].

        Returns:
            Values, in [m], of the broadcast shape of the arguments.

        Raises:
            PlanError: If an angle is outside [-2 pi, 2 pi].
        """
        return self._value(*_checked(distance, error, bearing))

    def _value(self, r: Array, error: Array, bearing: Array) -> Array:
        """Interpolate at angles that may lie beyond a turn."""
        found = self._look_up(r, error, bearing)
        beyond = np.maximum(r - self.grid.far, 0.0)
        value: Array = np.where(r < self.grid.near, r, found + beyond)
        return value

    def evader_turn(
        self, distance: ArrayLike, error: ArrayLike, bearing: ArrayLike
    ) -> Array:
        """Return the optimal turning rate of the evader; see :meth:`value`.

        The evader turns at its full rate towards larger values, and holds
        its bearing on a ridge. Where the value is flat it turns away.

        Returns:
            Turning rates, in [rad/s].
        """
        r, a, psi = np.broadcast_arrays(*_checked(distance, error, bearing))
        step = self.grid.spacings[2]
        before, here, after = self._value(
            r, a, np.stack([psi - step, psi, psi + step])
        )
        swing = self._swing(r, a, psi)
        limit = self.game.evader_turn
        habit = limit * np.clip(wrap_angles(psi) / step, -1.0, 1.0)
        flat = FLAT * step * self.game.unit
        return _steer(before, here, after, swing, limit, habit, flat)

    def pursuer_turn(
        self, distance: ArrayLike, error: ArrayLike, bearing: ArrayLike
    ) -> Array:
        """Return the optimal turning rate of the pursuer; see :meth:`value`.

        A pursuer with a law follows that law; any other turns towards the
        evader where the value is flat.

        Returns:
            Turning rates, in [rad/s].
        """
        r, a, psi = np.broadcast_arrays(*_checked(distance, error, bearing))
        law = self.game.pursuer_gain * wrap_angles(a)
        if self.game.pursuer_turn == 0.0:
            return law
        step = self.grid.spacings[1]
        before, here, after = self._value(
            r, np.stack([a - step, a, a + step]), psi
        )
        swing = self._swing(r, a, psi) - law
        limit = self.game.pursuer_turn
        habit = limit * np.clip(wrap_angles(a) / step, -1.0, 1.0)
        flat = FLAT * step * self.game.unit
        return law + _steer(-before, -here, -after, swing, limit, habit, flat)

    def barrier(self, capture: float) -> Array:
        """Return the largest distance from which capture is possible.

        Args:
            capture: Capture distance, in [m].

        Returns:
            For each pair of bearings the largest distance at which the value
            crosses the capture distance, in [m]; the capture distance itself
            where the evader always escapes. Shape (a, psi) of the grid.

        Raises:
            PlanError: If the capture distance is outside the grid.
        """
        near, far = self.grid.near, self.grid.far
        check_within(capture, near, far, "capture", "m")
        r = self.grid.axes()[1]
        captured = self.values < capture
        captured[:, r < capture] = True
        last = len(r) - 1 - captured[:, ::-1].argmax(axis=1)
        after = np.minimum(last + 1, len(r) - 1)
        low, high = (
            np.take_along_axis(self.values, n[:, None], axis=1)[:, 0]
            for n in (last, after)
        )
        rise = np.maximum(high - low, 1e-12)
        fraction = np.clip((capture - low) / rise, 0.0, 1.0)
        reach = r[last] + fraction * (r[after] - r[last])
        distances: Array = np.maximum(reach, capture)
        return distances

    def save(self, path: AnyPath) -> None:
        """Write the tables and all settings to one ``.npz`` file."""
        from ... import __version__

        head = {
            "format": FORMAT,
            "version": __version__,
            "game": asdict(self.game),
            "grid": asdict(self.grid),
            "horizon": self.horizon,
            "falling_mean": self.falling_mean,
            "falling_worst": self.falling_worst,
            "seconds": self.seconds,
        }
        a, r, psi = self.grid.axes()
        nodes = r[:, None], a[:, None, None], psi
        with (
            atomic_draft(as_path(path, "path")) as draft,
            draft.open("wb") as file,
        ):
            np.savez_compressed(
                file,
                head=np.array(dumps(head)),
                values=self.values,
                evader_turn=self.evader_turn(*nodes).astype(np.float32),
                pursuer_turn=self.pursuer_turn(*nodes).astype(np.float32),
            )

    @cached_property
    def _around(self) -> Values:
        """Values over all bearings, with one more node on every side."""
        whole = np.concatenate([self.values[::-1, :, ::-1], self.values])
        return np.pad(whole, ((1, 1), (0, 0), (1, 1)), mode="wrap")

    def _swing(self, r: Array, a: Array, psi: Array) -> Array:
        """Return the turning rate of the line of sight, in [rad/s]."""
        vp, ve = self.game.pursuer_speed, self.game.evader_speed
        swing: Array = (vp * np.sin(a) - ve * np.sin(psi)) / r
        return swing

    def _look_up(self, distance: Array, error: Array, bearing: Array) -> Array:
        """Interpolate linearly, with distances clipped to the grid."""
        from scipy.ndimage import map_coordinates

        step_r, step_a, step_psi = self.grid.spacings
        places = np.broadcast_arrays(
            (wrap_angles(error) + pi) / step_a + 0.5,
            (distance - self.grid.near) / step_r,
            (wrap_angles(bearing) + pi) / step_psi + 0.5,
        )
        rows = np.reshape(places, (3, -1))
        found: Array = map_coordinates(
            self._around, rows, np.float64, order=1, mode="nearest"
        )
        return found.reshape(places[0].shape)


def load_bound(path: AnyPath) -> Bound:
    """Read a table written by :meth:`Bound.save`.

    Raises:
        PlanError: If the file is not a valid table.
    """
    path = as_path(path, "path", PlanError)
    try:
        with np.load(path, allow_pickle=False) as file:
            head = loads(str(file["head"]))
            values = file["values"]
        if head["format"] != FORMAT:
            raise PlanError(
                f"{path} has format {head['format']}, this reads {FORMAT}"
            )
        game, grid = BoundGame(**head["game"]), Grid(**head["grid"])
        rest = ("format", "version", "game", "grid")
        settings = {k: v for k, v in head.items() if k not in rest}
        return Bound(game, grid, values, **settings)
    except (
        OSError,
        EOFError,
        KeyError,
        ValueError,
        TypeError,
        BadZipFile,
    ) as error:
        if isinstance(error, PlanError):
            raise
        raise PlanError(
            f"{path} is not a valid table of a bound: {error}"
        ) from error


def _checked(
    distance: ArrayLike, error: ArrayLike, bearing: ArrayLike
) -> tuple[Array, Array, Array]:
    """Return distances, errors and bearings as arrays, or raise."""
    angles = np.asarray(error, np.float64), np.asarray(bearing, np.float64)
    check_bearings(angles[0], "error")
    check_bearings(angles[1], "bearing")
    return np.asarray(distance, np.float64), *angles


def _steer(
    before: Array,
    here: Array,
    after: Array,
    swing: Array,
    limit: float,
    habit: Array,
    flat: float,
) -> Array:
    """Return turning rates towards larger values.

    The values are those at the bearing and one cell before and after it. A
    turn to the left decreases a bearing. Near the top of a parabola through
    the three values the bearing is brought to the top and held there; where
    they differ by less than ``flat`` the rate is ``habit``.
    """
    slope, bend = after - before, after - 2.0 * here + before
    top = -0.5 * slope / np.minimum(bend, -1e-12)  # in cells
    hold = np.clip(swing, -limit, limit) * (1.0 - np.abs(top)) - limit * top
    ridge = (bend < 0.0) & (np.abs(top) < 1.0)
    full = np.where(slope > 0.0, -limit, limit)
    turn = np.where(ridge, np.clip(hold, -limit, limit), full)
    same = (np.abs(slope) < flat) & (np.abs(bend) < flat)
    chosen: Array = np.where(same, habit, turn)
    return chosen
