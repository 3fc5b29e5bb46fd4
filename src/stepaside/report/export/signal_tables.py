"""Series and events of a recording as tables: CSV or Parquet."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...core.poses import Array
from ...games.replayed_signals import RobotSignals
from ..landed_footsteps import landed_footsteps
from .recording import Recording

# Arrays of a trajectory that have one row per sample, with their columns.
TRACK_COLUMNS = {
    "com": ("x_m", "y_m", "z_m"),
    "torso": ("x_m", "y_m", "heading_rad"),
    "place": ("x_m", "y_m", "heading_rad"),
    "com_reference": ("x_m", "y_m"),
    "zmp_reference": ("x_m", "y_m"),
    "zmp": ("x_m", "y_m"),
    "velocity": ("x_m_s", "y_m_s"),
    "tilt": ("roll_rad", "pitch_rad"),
    "sole": ("x_m", "y_m", "heading_rad"),
    "heading_reference": ("heading_rad",),
    "estimate": (
        "com_x_m",
        "com_y_m",
        "velocity_x_m_s",
        "velocity_y_m_s",
        "zmp_x_m",
        "zmp_y_m",
        "roll_rad",
        "pitch_rad",
    ),
    "command": (
        "template_forward_m_s",
        "template_turn_rad_s",
        "template_lateral_m_s",
        "forward_m_s",
        "turn_rad_s",
        "lateral_m_s",
    ),
}
FOOT_CORNERS = tuple(
    f"{side}_{place}_n"
    for side in ("left", "right")
    for place in ("front_left", "front_right", "rear_left", "rear_right")
)
SIGNAL_COLUMNS = {
    "torso_velocity": (
        "x_m_s",
        "y_m_s",
        "z_m_s",
        "about_x_rad_s",
        "about_y_rad_s",
        "about_z_rad_s",
    ),
    "gyro": ("x_rad_s", "y_rad_s", "z_rad_s"),
    "accelerometer": ("x_m_s2", "y_m_s2", "z_m_s2"),
    "foot_forces": FOOT_CORNERS,
    "com_velocity": ("x_m_s", "y_m_s"),
    "dcm": ("x_m", "y_m"),
}
JOINT_SIGNALS = {
    "joint_velocity": "rad_s",
    "joint_effort": "n_m",
}


class Series(NamedTuple):
    """Values at the samples of a run.

    Attributes:
        name: Name with the player before it, like ``pursuer/com``.
        columns: Names of the columns, with units.
        values: Values. Shape (n, columns).
    """

    name: str
    columns: tuple[str, ...]
    values: Array


class EventTable(NamedTuple):
    """Rows that are not at the samples of a run.

    Attributes:
        name: Name with the player, like ``pursuer-footsteps-planned``.
        columns: Names of the columns; the first is the time.
        rows: Rows. Shape (m, columns).
    """

    name: str
    columns: tuple[str, ...]
    rows: Array


def all_series(recording: Recording) -> list[Series]:
    """Return all series of all players, then those of pairs."""
    found: list[Series] = []
    for name in recording.run.players:
        found += series_of(recording, name)
    run = recording.run
    if run.pair is not None:
        found.append(Series("distance", ("m",), run.distance[:, None]))
    if run.has_orientation:
        angle = np.radians(run.orientation)[:, None]
        found.append(Series("angle_between_headings", ("rad",), angle))
    return found


def series_of(recording: Recording, player: str) -> Iterator[Series]:
    """Yield the series of one player.

    Args:
        recording: The recording.
        player: Name of the player.
    """
    track = recording.run.tracks[player]
    for key, columns in TRACK_COLUMNS.items():
        values = getattr(track, key)
        if values is not None:
            yield Series(f"{player}/{key}", columns, values)
    model = recording.models.get(player)
    joints = () if model is None else model.joints
    if track.qpos is not None and model is not None:
        qpos = track.qpos.astype(np.float64)
        pose = ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")
        yield Series(f"{player}/base_link", pose, qpos[:, :7])
        names = tuple(f"{joint}_rad" for joint in joints)
        yield Series(f"{player}/joint_position", names, qpos[:, 7:])
    signals = recording.signals.get(player)
    if signals is not None:
        yield from _signal_series(player, joints, signals)


def _signal_series(
    player: str, joints: tuple[str, ...], signals: RobotSignals
) -> Iterator[Series]:
    for key, unit in JOINT_SIGNALS.items():
        values = getattr(signals, key)
        if values is not None:
            names = tuple(f"{joint}_{unit}" for joint in joints)
            yield Series(f"{player}/{key}", names, values)
    if signals.joint_targets is not None:
        names = tuple(f"{joint}_rad" for joint in signals.target_names)
        yield Series(f"{player}/joint_target", names, signals.joint_targets)
    for key, columns in SIGNAL_COLUMNS.items():
        values = getattr(signals, key)
        if values is not None:
            yield Series(f"{player}/{key}", columns, values)
    if signals.strategy:
        yield Series(
            f"{player}/strategy",
            tuple(signals.strategy),
            np.column_stack(list(signals.strategy.values())),
        )


def all_events(recording: Recording) -> list[EventTable]:
    """Return the tables of footsteps, sightings and pushes."""
    found: list[EventTable] = []
    for name in recording.run.players:
        found += _events_of(recording, name)
    return found


def _events_of(recording: Recording, player: str) -> Iterator[EventTable]:
    track = recording.run.tracks[player]
    step = ("time_s", "side", "x_m", "y_m", "heading_rad")
    if track.landings is not None:
        landings = f"{player}-footsteps-planned"
        yield EventTable(landings, step, track.landings)
        model = recording.models.get(player)
        if model is not None and track.qpos is not None:
            landed = landed_footsteps(
                model.description, recording.run.times, track
            )
            yield EventTable(f"{player}-footsteps-landed", step, landed)
    signals = recording.signals.get(player)
    if signals is not None and signals.plans:
        rows = [
            (plan.time, float(number), *footstep)
            for plan in signals.plans
            for number, footstep in enumerate(plan.footsteps.tolist())
        ]
        columns = ("time_s", "number", *step[1:])
        yield EventTable(f"{player}-plans", columns, np.array(rows))
    if track.sight is not None:
        columns = (
            "time_s",
            "bearing_rad",
            "distance_m",
            "true_bearing_rad",
            "true_distance_m",
            "is_lost",
        )
        yield EventTable(f"{player}-sightings", columns, track.sight)
    if track.pushes is not None:
        columns = (
            "time_s",
            "duration_s",
            "x_m",
            "y_m",
            "impulse_x_n_s",
            "impulse_y_n_s",
        )
        yield EventTable(f"{player}-pushes", columns, track.pushes)


def write_csv(folder: Path, recording: Recording) -> None:
    """Write the samples and each kind of event as CSV files.

    Args:
        folder: Folder of the files.
        recording: The recording.
    """
    for name, columns in tables_of(recording).items():
        rows = np.column_stack(list(columns.values()))
        lines = [",".join(columns)]
        lines += [
            ",".join("" if value != value else repr(value) for value in row)
            for row in rows.tolist()
        ]
        text = "\n".join(lines) + "\n"
        (folder / f"{name}.csv").write_text(text, encoding="utf-8")


def write_parquet(folder: Path, recording: Recording) -> None:
    """Write the samples and each kind of event as Parquet files.

    Args:
        folder: Folder of the files.
        recording: The recording.
    """
    import polars

    for name, columns in tables_of(recording).items():
        frame = polars.DataFrame(columns).fill_nan(None)
        frame.write_parquet(folder / f"{name}.parquet")


def tables_of(recording: Recording) -> dict[str, dict[str, Array]]:
    """Return the columns of each table, by its name and theirs.

    The table ``samples`` has a row per sample. NaN stands for missing values.
    """
    columns = {"time_s": recording.run.times}
    for series in all_series(recording):
        for column, values in zip(
            series.columns, series.values.T, strict=True
        ):
            columns[f"{series.name}/{column}"] = values.astype(np.float64)
    tables = {"samples": columns}
    for table in all_events(recording):
        rows = table.rows.astype(np.float64)
        tables[table.name] = dict(zip(table.columns, rows.T, strict=True))
    return tables
