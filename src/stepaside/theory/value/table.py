"""Table of a solved game: values and decisions of both players."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.atomic_output import atomic_draft
from ...core.brief_repr import brief_repr
from ...core.errors import AnyPath, PlanError, as_path
from ...core.poses import Array
from .outcomes import OutcomeRules, choose_all, look_up_all
from .pose_grid import PoseGrid

Numbers = NDArray[np.int64]
PARTS = ("values", "after", "motions", "answers", "change", "seconds")
UNREADABLE = (OSError, EOFError, KeyError, ValueError, TypeError, BadZipFile)
TIE = 1e-3  # weight of the value after a period where it decides nothing


@dataclass(frozen=True)
class ValueTable:
    """Distance that a robot can keep, by its pose in the opponent's frame."""

    values: Array  # distances of the nodes, in [m]. Shape grid.shape
    after: Array  # least values within the disturbance, likewise
    motions: Array  # motions of the robot. Shape (n, parts, 3)
    answers: Array  # motions of its opponent. Shape (m, parts, 3)
    rules: OutcomeRules  # how outcomes are read from the values
    change: float  # how much a value still fell over the last period, in [m]
    seconds: float  # computing time, in [s]

    __repr__ = brief_repr

    @property
    def grid(self) -> PoseGrid:
        """Grid of the poses."""
        own = self.rules
        shape = own.columns, own.rows, own.headings
        return PoseGrid(own.left, own.spacing, shape, own.right)

    def value(self, poses: ArrayLike) -> Array:
        """Return the distances that the robot can keep, in [m].

        Poses are those of the robot in the frame of its opponent, in [m] and
        [rad]. Shape (..., 3).
        """
        return interpolated(self.values, poses, self.rules)

    def best_motion(self, poses: ArrayLike) -> Numbers:
        """Return the number of the motion that keeps the largest distance.

        Where it does not matter, the value after it decides.
        """
        chosen: Numbers = self.decisions(poses)[..., 0]
        return chosen

    def decisions(self, poses: ArrayLike) -> Numbers:
        """Return the numbers of best motions and of answers to them.

        Shape (..., 2).
        """
        states = np.asarray(poses, dtype=np.float64)
        out = np.zeros((states.size // 3, 2), np.int64)
        choose_all(
            self.after,
            np.ascontiguousarray(states.reshape(-1, 3)),
            self.motions,
            self.answers,
            self.rules._replace(tie=TIE),
            out,
        )
        return out.reshape(*states.shape[:-1], 2)

    def save(self, path: AnyPath) -> None:
        """Write the table to one ``.npz`` file."""
        with (
            atomic_draft(as_path(path, "path")) as draft,
            draft.open("wb") as file,
        ):
            arrays: dict[str, Any] = dict(self.arrays())
            np.savez_compressed(file, **arrays)

    def arrays(self) -> dict[str, Array]:
        """Return all that the table consists of, by name."""
        found = {name: np.asarray(getattr(self, name)) for name in PARTS}
        return found | {"rules": np.array(self.rules, dtype=np.float64)}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, Array]) -> "ValueTable":
        """Return the table of :meth:`arrays`."""
        kinds = OutcomeRules.__annotations__.values()
        row = zip(kinds, arrays["rules"].tolist(), strict=True)
        rules = OutcomeRules._make(kind(value) for kind, value in row)
        v, after, motions, answers, *rest = (arrays[name] for name in PARTS)
        change, seconds = map(float, rest)
        return cls(v, after, motions, answers, rules, change, seconds)


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


def interpolated(
    values: Array, poses: ArrayLike, rules: OutcomeRules
) -> Array:
    """Interpolate values of nodes; see :meth:`ValueTable.value`."""
    states = np.asarray(poses, dtype=np.float64)
    out = np.empty(states.size // 3)
    rows = np.ascontiguousarray(states.reshape(-1, 3))
    look_up_all(values, rows, rules, out)
    return out.reshape(states.shape[:-1])
