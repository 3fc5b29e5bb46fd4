"""Series and events of a recording as tables: CSV or Parquet."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ...core.poses import Array
from ...games.trajectory import COLUMNS
from ..overlays import footsteps_in
from .recording import Recording

JOINTS = {
    "joint_position": "rad",
    "joint_velocity": "rad_s",
    "joint_effort": "n_m",
    "joint_targets": "rad",
}
"""Units of the columns of joints."""
EVENTS = {
    "landings": "footsteps-planned",
    "plans": "plans",
    "sight": "sightings",
    "pushes": "pushes",
}
"""Names of the tables of rows that are not at samples."""
Rows = tuple[str, tuple[str, ...], Array]
"""Name, names of the columns with units, and values of shape (n, columns)."""


def _series_of(recording: Recording, player: str) -> Iterator[Rows]:
    """Yield the values of one player at the samples of the run."""
    track = recording.run.tracks[player]
    model = recording.models.get(player)
    for name, rows in track.arrays().items():
        if name in EVENTS:
            continue
        if model is None or not (name == "qpos" or name in JOINTS):
            yield f"{player}/{name}", COLUMNS[name], rows
            continue
        if name == "qpos":
            pose = ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")
            yield f"{player}/base_link", pose, rows[:, :7]
            name, rows = "joint_position", rows[:, 7:]
        unit = JOINTS[name]
        columns = tuple(f"{joint}_{unit}" for joint in model.joints)
        yield f"{player}/{name}", columns, rows
    if track.strategy:
        values = np.column_stack(list(track.strategy.values()))
        yield f"{player}/strategy", tuple(track.strategy), values


def _events_of(recording: Recording, player: str) -> Iterator[Rows]:
    """Yield the rows of one player that are not at the samples of the run."""
    track = recording.run.tracks[player]
    for name, table in EVENTS.items():
        rows = getattr(track, name)
        if rows is not None:
            yield f"{player}-{table}", COLUMNS[name], rows
    if track.landings is not None and track.qpos is not None:
        landed = footsteps_in(recording.run, player)
        yield f"{player}-footsteps-landed", COLUMNS["landings"], landed


def write_tables(folder: Path, recording: Recording, kind: str) -> None:
    """Write samples and each kind of event as files, csv or parquet."""
    for name, columns in tables_of(recording).items():
        file = folder / f"{name}.{kind}"
        if kind == "parquet":
            import polars

            polars.DataFrame(columns).fill_nan(None).write_parquet(file)
            continue
        lines = [",".join(columns)]
        lines += [
            ",".join("" if value != value else repr(value) for value in row)
            for row in np.column_stack(list(columns.values())).tolist()
        ]
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def tables_of(recording: Recording) -> dict[str, dict[str, Array]]:
    """Return the columns of each table, by its name and theirs.

    The table ``samples`` has a row per sample. NaN stands for missing values.
    """
    run = recording.run
    series = [s for name in run.players for s in _series_of(recording, name)]
    if run.pair is not None:
        series.append(("distance", ("m",), run.distance[:, None]))
    if run.has_orientation:
        angle = np.radians(run.orientation)[:, None]
        series.append(("angle_between_headings", ("rad",), angle))
    samples = {"time_s": run.times}
    for name, columns, rows in series:
        for column, values in zip(columns, rows.T, strict=True):
            samples[f"{name}/{column}"] = values.astype(np.float64)
    tables = {"samples": samples}
    for player in run.players:
        for name, columns, rows in _events_of(recording, player):
            values = rows.astype(np.float64).T
            tables[name] = dict(zip(columns, values, strict=True))
    return tables
