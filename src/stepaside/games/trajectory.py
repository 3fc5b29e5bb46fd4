"""Recorded motion of one player, and reading of files of arrays."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from io import BytesIO
from pathlib import Path

import numpy as np

from ..core.brief_repr import brief_repr
from ..core.errors import ConfigurationError
from ..core.poses import Array

MAX_BYTES = 2**30  # of a file, and of all its arrays; a game of a day has less
MAX_HEADER_BYTES = 512  # of one array


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Recorded motion of one player, one row per sample unless noted.

    Positions are in the world, in [m], angles in [rad]; headings are
    unwrapped. Arrays that a player lacks are None; the last seven but
    ``command`` are recorded in walks only.
    """

    __repr__ = brief_repr

    com: Array  # CoM (x, y, z)
    torso: Array  # origin and heading of the torso (x, y, heading)
    place: Array | None = None  # reference point and heading (x, y, heading)
    com_reference: Array | None = None  # planned CoM (x, y)
    zmp_reference: Array | None = None  # planned ZMP (x, y)
    zmp: Array | None = None  # center of the foot forces (x, y); or NaN
    qpos: Array | None = None
    """Position and quaternion of the torso, and joint angles, as float32."""
    landings: Array | None = None
    """Of each footstep: time [s], side (1 left, -1 right), x, y, heading."""
    sight: Array | None = None
    """Of each sighting: time [s], estimated bearing and distance, true bearing
    and distance, 1 while the opponent is lost."""
    pushes: Array | None = None
    """Of each push: time and duration [s], position of the torso (x, y) [m],
    impulse (x, y) [N s]."""
    velocity: Array | None = None  # of the CoM (x, y), in [m/s]
    tilt: Array | None = None  # roll and pitch of the torso
    sole: Array | None = None  # pose of the support sole (x, y, heading)
    support: Array | None = None
    """Support foot (1 left, -1 right), 1 in single support, planned pose of
    the sole (x, y, heading)."""
    heading_reference: Array | None = None  # of the torso, one column
    estimate: Array | None = None
    """Estimated CoM, its velocity and ZMP (x, y each), roll, pitch; or NaN."""
    command: Array | None = None
    """Velocities of a robot with its own walk: of the template and as
    commanded, forward [m/s], turn [rad/s] and lateral [m/s] each."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for field in fields(self):
            value = getattr(self, field.name)
            if value is not None:
                value.setflags(write=False)

    @property
    def unicycle(self) -> Array:
        """Reference point and heading (x, y, heading). Shape (n, 3).

        Without a recorded reference point that of the torso is used.
        """
        return self.torso if self.place is None else self.place

    def arrays(self, name: str) -> dict[str, Array]:
        """Return all arrays by name, with the player's name as prefix."""
        found = {}
        for field in fields(self):
            value = getattr(self, field.name)
            if value is not None:
                found[f"{name}_{field.name}"] = value
        return found


FIELDS = tuple(field.name for field in fields(Trajectory))


WIDTHS: Mapping[str, int] = {
    **dict.fromkeys(("com", "torso", "place", "sole"), 3),
    **dict.fromkeys(("com_reference", "zmp_reference", "zmp"), 2),
    **dict.fromkeys(("velocity", "tilt"), 2),
    **dict.fromkeys(("landings", "support"), 5),
    **dict.fromkeys(("sight", "pushes", "command"), 6),
    **{"heading_reference": 1, "estimate": 8},
}
"""Columns of each array of a trajectory; qpos has at least seven."""
OF_EVENTS = ("landings", "sight", "pushes")  # not of samples
MAY_LACK = ("zmp", "sight", "estimate")  # values may be NaN
MAX_VALUE = 1e6  # of any number in a run, in [m], [rad] or [s]


def tracks_in(
    arrays: dict[str, Array], names: tuple[str, ...]
) -> dict[str, Trajectory]:
    """Return the trajectories of players; KeyError if an array is missing."""
    required = ("com", "torso")
    return {
        name: Trajectory(
            **{
                key: np.asarray(arrays[f"{name}_{key}"])
                for key in FIELDS
                if key in required or f"{name}_{key}" in arrays
            }
        )
        for name in names
    }


def check_record(
    times: Array, tracks: Mapping[str, Trajectory], run: str
) -> None:
    """Check times, and shapes and values of trajectories.

    Raises:
        ConfigurationError: If times do not increase, an array has another
            shape, or a value is not finite or too large.
    """
    if times.ndim != 1 or len(times) == 0:
        raise ConfigurationError(
            f"times_s of run {run} must be a row of at least one time [s], "
            f"got shape {times.shape}"
        )
    _check_values(times, "times_s", run)
    if times[0] < 0.0 or not np.all(np.diff(times) > 0.0):
        raise ConfigurationError(
            f"times_s of run {run} must be >= 0 and increase [s]"
        )
    for player, track in tracks.items():
        for key in FIELDS:
            array = getattr(track, key)
            if array is None:
                continue
            shape = array.shape if array.ndim == 2 else (-1, 0)
            rows = shape[0] if key in OF_EVENTS else len(times)
            width = WIDTHS.get(key, max(7, shape[1]))
            if shape != (rows, width):
                raise ConfigurationError(
                    f"{player}_{key} of run {run} must have shape "
                    f"({rows}, {width}), got {array.shape}"
                )
            _check_values(array, f"{player}_{key}", run, key in MAY_LACK)


def _check_values(
    array: Array, name: str, run: str, may_lack: bool = False
) -> None:
    valid = np.abs(array) <= MAX_VALUE
    if may_lack:
        valid |= np.isnan(array)
    if not valid.all():
        raise ConfigurationError(
            f"{name} of run {run} must hold finite numbers of at most "
            f"{MAX_VALUE:g}"
        )


def read_bytes(file: Path) -> bytes:
    """Read a regular file that is not too large; ValueError for others."""
    if not file.is_file() or file.stat().st_size > MAX_BYTES:
        raise ValueError(f"{file.name} must be a file of <= {MAX_BYTES} bytes")
    return file.read_bytes()


def read_arrays(file: Path) -> dict[str, Array]:
    """Read the arrays of an ``npz`` file by name; all hold real numbers.

    Damaged files raise what numpy and zipfile raise, or ValueError.
    """
    with np.load(
        BytesIO(read_bytes(file)),
        allow_pickle=False,
        max_header_size=MAX_HEADER_BYTES,
    ) as archive:
        size = sum(member.file_size for member in archive.zip.infolist())
        if size > MAX_BYTES:
            raise ValueError(
                f"arrays of {file.name} must have at most {MAX_BYTES} "
                f"bytes, got {size}"
            )
        arrays = {name: np.asarray(archive[name]) for name in archive.files}
    for name, array in arrays.items():
        if array.dtype not in (np.float32, np.float64) or array.ndim > 2:
            raise ValueError(f"{name} must be a table of real numbers")
    return arrays
