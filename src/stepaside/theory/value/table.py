r"""Games on a grid of relative poses, solved by exact steps.

At each decision a robot commits to a motion for a period; its opponent
answers it; and at the end the position of the robot is displaced by up to a
disturbance :math:`\epsilon`. With :math:`T` the motion over a period and
:math:`d` the least distance on the way, the distance that the robot can keep
for ever is

.. math::
    V(x) = \max_w \min_u \min\bigl(d(x, w, u),
    \min_{|\delta| \le \epsilon} V(T(x, w, u) + \delta)\bigr).

Values begin at the distance and only fall. A period of several cells costs
little, and values are interpolated rarely: that keeps barriers sharp, where
schemes that advance less than a cell at a time smooth them out.
"""

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from hashlib import sha256
from math import ceil, cos, inf, log, pi, sqrt, tau
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple
from zipfile import BadZipFile

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.atomic_output import atomic_draft
from ...core.compiled_cache import cache_folder
from ...core.errors import AnyPath, PlanError, as_path, check_positive
from ...core.poses import Array, arc
from .outcomes import PoseGrid, choose_all, look_up_all, relax

ARRAYS = ("values", "after", "motions", "answers", "change", "seconds")
UNREADABLE = (OSError, EOFError, KeyError, ValueError, TypeError, BadZipFile)
FORMAT = 8  # of the files in the cache folder
TIE = 1e-3  # weight of the value after a period where it decides nothing
PARTS = 4  # of a period, in which the distance is measured
MOST = 600  # periods
UNTIL = 1e-4  # change in a period that counts as none, in [m]
DIRECTIONS = 64  # in which the reach of a table is looked for


@dataclass(frozen=True)
class ValueTable:
    """Distance that a robot can keep, by its pose in the opponent's frame.

    Poses are in [m] and [rad]. Shape (..., 3).
    """

    values: Array  # distances of the nodes, in [m]. Shape grid.shape
    after: Array  # least values within the disturbance, likewise
    motions: Array  # motions of the robot. Shape (n, PARTS, 3)
    answers: Array  # motions of its opponent. Shape (m, PARTS, 3)
    grid: PoseGrid  # of the poses
    change: float  # how much a value still fell over the last period, in [m]
    seconds: float  # computing time, in [s]

    def value(self, poses: ArrayLike) -> Array:
        """Return the distances that the robot can keep, in [m]."""
        return interpolated(self.values, poses, self.grid)

    def best_motion(self, poses: ArrayLike) -> NDArray[np.int64]:
        """Return the number of the motion that keeps the largest distance.

        Where it does not matter, the value after it decides.
        """
        chosen: NDArray[np.int64] = self.decisions(poses)[..., 0]
        return chosen

    def decisions(self, poses: ArrayLike) -> NDArray[np.int64]:
        """Return the numbers of best motions and of answers to them.

        Shape (..., 2).
        """
        states = np.ascontiguousarray(poses, dtype=np.float64)
        out = np.zeros((*states.shape[:-1], 2), np.int64)
        choose_all(
            self.after,
            states.reshape(-1, 3),
            self.motions,
            self.answers,
            self.grid._replace(tie=TIE),
            out.reshape(-1, 2),
        )
        return out

    def reach(self, distance: float) -> float:
        """Return from how far on a distance cannot be kept, at most, in [m].

        To a sixteenth of a cell; the distance itself, if it can be kept.
        """
        r = np.arange(distance, self.grid.edge, self.grid.spacing / 16.0)
        angles = tau / DIRECTIONS * np.arange(DIRECTIONS)
        found = distance
        for theta in self.grid.axes()[2].tolist():
            x, y = r[:, None] * np.cos(angles), r[:, None] * np.sin(angles)
            poses = np.stack([x, y, np.full_like(x, theta)], axis=-1)
            lost = (self.value(poses) < distance).any(axis=1)
            found = max(found, float(r[lost].max(initial=distance)))
        return found

    def offsets(self, poses: Array, distance: float) -> Array:
        """Return how far states are from where a distance can just be kept.

        To first order in the position, in [m]; positive where the table says
        that it cannot be kept. Poses have shape (n, 3).
        """
        step = self.grid.spacing * np.eye(3)[:2]
        rises = [self.value(poses + d) - self.value(poses - d) for d in step]
        slope = np.hypot(*rises) / (2.0 * self.grid.spacing)
        off: Array = (distance - self.value(poses)) / np.maximum(slope, 1e-3)
        return off

    def differences(self, coarse: "ValueTable") -> Array:
        """Return absolute differences at the nodes of a coarser table [m]."""
        axes = np.meshgrid(*coarse.grid.axes(), indexing="ij")
        off: Array = np.abs(self.value(np.stack(axes, -1)) - coarse.values)
        return off

    def save(self, path: AnyPath) -> None:
        """Write the table to one ``.npz`` file."""
        _write(as_path(path, "path"), self.arrays())

    def arrays(self) -> dict[str, Array]:
        """Return all that the table consists of, by name."""
        found = {name: np.asarray(getattr(self, name)) for name in ARRAYS}
        return found | {"grid": np.array(self.grid, dtype=np.float64)}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, Array]) -> "ValueTable":
        """Return the table of :meth:`arrays`."""
        kinds = PoseGrid.__annotations__.values()
        row = zip(kinds, arrays["grid"].tolist(), strict=True)
        grid = PoseGrid._make(kind(value) for kind, value in row)
        v, after, motions, answers, *rest = (arrays[name] for name in ARRAYS)
        change, seconds = map(float, rest)
        return cls(v, after, motions, answers, grid, change, seconds)


def load_table(path: AnyPath) -> ValueTable:
    """Read a table written by :meth:`ValueTable.save`."""
    path = as_path(path, "path", PlanError)
    try:
        with np.load(path, allow_pickle=False) as file:
            return ValueTable.from_arrays(file)
    except UNREADABLE as error:
        raise PlanError(
            f"{path} is not a valid table of a game: {error}"
        ) from error


def _write(path: Path, arrays: Mapping[str, Any]) -> None:
    with atomic_draft(path) as draft, draft.open("wb") as file:
        np.savez_compressed(file, **arrays)


def cached(
    name: str, key: object, solve: Callable[[], Mapping[str, Array]]
) -> Mapping[str, Array]:
    """Return arrays from the cache folder by their key, or solve them."""
    digest = sha256(repr((FORMAT, key)).encode()).hexdigest()
    file = cache_folder() / f"{name}-{digest[:16]}.npz"
    try:
        with np.load(file) as saved:
            return dict(saved)
    except UNREADABLE:
        found = solve()
    with suppress(OSError):  # the cache only saves time
        _write(file, found)
    return found


class PursuerLaw(NamedTuple):
    """Pursuer that drives on and turns by eq. (2), in place of answers."""

    speed: float  # [m/s]
    gain: float  # [1/s]
    period: float  # for which the robot commits to a motion, in [s]


def solve_game(
    motions: Array,
    answers: Array | PursuerLaw,
    grid: PoseGrid,
    *,
    disturbance: float = 0.0,
    until: float = UNTIL,
    most: float = inf,
    outside: Callable[[Array], float] = lambda _: inf,
    reach: float = inf,
    periods: int = MOST,
    progress: Callable[[float], object] | None = None,
) -> ValueTable:
    """Compute the distance that a robot can keep from every state.

    Args:
        motions: Motions of the robot; see :func:`.sub_poses`. Shape
            (n, PARTS, 3).
        answers: Those of its opponent, shape (m, PARTS, 3), or its law.
        grid: Poses of the robot in the frame of its opponent, and how
            outcomes are read from their values.
        disturbance: Radius of the displacement after a motion, in [m].
        until: Change in a period that counts as none, in [m].
        most: Cut-off of the values, in [m].
        outside: Returns the value outside the grid from the values of the
            nodes: infinite for that of the edge plus the distance; zero ends
            the solution, since nothing can be kept.
        reach: Distance from changes within which values may change, in [m].
        periods: Largest number of periods that are looked ahead.
        progress: Called with fractions of the work done since the last call.
    """
    begin, done, first, change = perf_counter(), 0.0, 0.0, inf
    check_positive(until, "until", "m")
    v = grid.distances(most)
    grid = grid._replace(outside=outside(v))
    if isinstance(answers, PursuerLaw):
        part = answers.period / PARTS
        way, rate = answers.speed * part, answers.gain * part
        grid, answers = grid._replace(way=way, rate=rate), no_answer()
    guesses = np.zeros((*grid.shape, 2), np.int32)
    changes, after = np.zeros(grid.shape[:2]), v
    active = near((v < most).any(axis=2), grid, reach)
    for n in range(periods if grid.outside else 0):
        after = least_within(v, grid, disturbance)
        after = after.copy() if after is v else after
        relax(v, after, guesses, active, motions, answers, grid, changes)
        grid = grid._replace(outside=outside(v))
        change = float(changes.max())
        first = max(first, change)
        if change < until or not grid.outside:
            break
        if progress is not None:
            part = (n + 1) / periods
            if change < first:
                part = max(part, log(first / change) / log(first / until))
            progress(max(part - done, 0.0))
            done = max(part, done)
        active = near(changes > 0.0, grid, reach)
    if progress is not None:
        progress(1.0 - done)
    after = least_within(v, grid, disturbance)
    seconds = perf_counter() - begin
    return ValueTable(v, after, motions, answers, grid, change, seconds)


def sub_poses(twists: ArrayLike, duration: float) -> Array:
    """Return poses along arcs at the ends of the parts of a duration.

    Args:
        twists: Velocities ahead [m/s], to the left [m/s] and turning [rad/s],
            held in the frame of the body. Shape (n, 3).
        duration: Duration, in [s].

    Returns:
        Poses in the initial frame, in [m] and [rad]. Shape (n, PARTS, 3).
    """
    rates = np.atleast_2d(np.asarray(twists, dtype=np.float64))
    times = duration * np.arange(1, PARTS + 1) / PARTS
    return arc(*(rates.T[:, :, None] * times))


def turning(speed: float, most: float, count: int) -> Array:
    """Return velocities with turning rates up to a largest. Shape (n, 3)."""
    rates = np.linspace(-most, most, count)
    return np.column_stack([np.full(count, speed), 0.0 * rates, rates])


def no_answer() -> Array:
    """Return one answer, at rest."""
    return np.zeros((1, PARTS, 3))


def interpolated(values: Array, poses: ArrayLike, grid: PoseGrid) -> Array:
    """Interpolate values of nodes; see :meth:`ValueTable.value`."""
    states = np.ascontiguousarray(poses, dtype=np.float64)
    out = np.empty(states.shape[:-1])
    look_up_all(values, states.reshape(-1, 3), grid, out.reshape(-1))
    return out


def near(marked: Any, grid: PoseGrid, reach: float) -> Any:
    """Return the columns that have a marked one within a reach, in [m]."""
    if reach == inf:
        return np.ones_like(marked)
    from scipy.ndimage import maximum_filter

    width = 2 * ceil(reach / grid.spacing) + 5
    return maximum_filter(marked, size=width, mode="nearest")


def step_back(
    after: Array,
    motions: Array,
    answers: Array,
    grid: PoseGrid,
    reach: float,
) -> Array:
    """Return values a motion, the best one, before those at its end.

    Values are at most the largest one after it; see :func:`solve_game`.
    """
    found = np.full(grid.shape, after.max())
    guesses = np.zeros((*grid.shape, 2), np.int32)
    active = near((after < after.max()).any(axis=2), grid, reach)
    changes = np.zeros(grid.shape[:2])
    relax(found, after, guesses, active, motions, answers, grid, changes)
    return found


def mirrored(values: Array) -> Array:
    """Return the values of mirrored poses, at nodes of a whole grid."""
    headings = -np.arange(values.shape[2]) % values.shape[2]
    return values[:, ::-1, headings]


def least_within(values: Array, grid: PoseGrid, radius: float) -> Array:
    """Return the least values within a displacement of the position, in [m].

    Values are interpolated linearly between nodes; eight directions of the
    displacement are tried.
    """
    found = values
    times = max(1, ceil(radius / grid.spacing))
    share = radius / times / grid.spacing / cos(pi / 8)
    for _ in range(times if radius > 0.0 else 0):
        # One more node on every side: mirrored at y = 0, else kept.
        around = np.pad(found, ((1, 1), (1, 1), (0, 0)), mode="edge")
        if grid.right == 0.0:
            around[1:-1, 0] = mirrored(found[:, 1:2])[:, 0]
            around[0, 0], around[-1, 0] = around[1, 0], around[-2, 0]
        least = found
        for di in (-1, 0, 1):
            for dj in (-1, 0, 1):
                if di or dj:
                    part = share / sqrt(di * di + dj * dj)
                    there = around[
                        1 + di : 1 + di + len(found),
                        1 + dj : 1 + dj + found.shape[1],
                    ]
                    least = np.minimum(
                        least, (1.0 - part) * found + part * there
                    )
        found = least
    return found
