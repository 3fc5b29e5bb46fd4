"""Series and events of a recording as tables: CSV or Parquet."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ...core.poses import Array
from ...games.replayed_signals import RobotSignals
from ..overlays import footsteps_in
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
        *("com_x_m", "com_y_m", "velocity_x_m_s", "velocity_y_m_s"),
        *("zmp_x_m", "zmp_y_m", "roll_rad", "pitch_rad"),
    ),
    "command": (
        *("template_forward_m_s", "template_turn_rad_s"),
        *("template_lateral_m_s", "forward_m_s", "turn_rad_s"),
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
        *("x_m_s", "y_m_s", "z_m_s"),
        *("about_x_rad_s", "about_y_rad_s", "about_z_rad_s"),
    ),
    "gyro": ("x_rad_s", "y_rad_s", "z_rad_s"),
    "accelerometer": ("x_m_s2", "y_m_s2", "z_m_s2"),
    "foot_forces": FOOT_CORNERS,
    "com_velocity": ("x_m_s", "y_m_s"),
    "dcm": ("x_m", "y_m"),
}
Rows = tuple[str, tuple[str, ...], Array]
"""Name, names of the columns with units, and values of shape (n, columns)."""


def _series_of(recording: Recording, player: str) -> Iterator[Rows]:
    """Yield the values of one player at the samples of the run."""
    track = recording.run.tracks[player]
    model = recording.models.get(player)
    signals = recording.signals.get(player, RobotSignals())
    joints = () if model is None else model.joints
    series: list[tuple[str, tuple[str, ...], Array | None]] = [
        (key, columns, getattr(track, key))
        for key, columns in TRACK_COLUMNS.items()
    ]
    if track.qpos is not None and model is not None:
        qpos = track.qpos.astype(np.float64)
        pose = ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")
        series.append(("base_link", pose, qpos[:, :7]))
        series.append(("joint_position", _named(joints, "rad"), qpos[:, 7:]))
    targets = _named(signals.target_names, "rad")
    series += [
        ("joint_velocity", _named(joints, "rad_s"), signals.joint_velocity),
        ("joint_effort", _named(joints, "n_m"), signals.joint_effort),
        ("joint_target", targets, signals.joint_targets),
    ]
    series += [
        (key, columns, getattr(signals, key))
        for key, columns in SIGNAL_COLUMNS.items()
    ]
    if signals.strategy:
        values = np.column_stack(list(signals.strategy.values()))
        series.append(("strategy", tuple(signals.strategy), values))
    for name, columns, rows in series:
        if rows is not None:
            yield f"{player}/{name}", columns, rows


def _named(joints: tuple[str, ...], unit: str) -> tuple[str, ...]:
    return tuple(f"{joint}_{unit}" for joint in joints)


def _events_of(recording: Recording, player: str) -> Iterator[Rows]:
    """Yield the rows of one player that are not at the samples of the run."""
    track = recording.run.tracks[player]
    step = ("time_s", "side", "x_m", "y_m", "heading_rad")
    if track.landings is not None:
        landings = f"{player}-footsteps-planned"
        yield landings, step, track.landings
        if track.qpos is not None:
            landed = footsteps_in(recording.run, player)
            yield f"{player}-footsteps-landed", step, landed
    signals = recording.signals.get(player)
    if signals is not None and signals.plans:
        rows = [
            (plan.time, float(number), *footstep)
            for plan in signals.plans
            for number, footstep in enumerate(plan.footsteps.tolist())
        ]
        columns = ("time_s", "number", *step[1:])
        yield f"{player}-plans", columns, np.array(rows)
    if track.sight is not None:
        columns = (
            *("time_s", "bearing_rad", "distance_m"),
            *("true_bearing_rad", "true_distance_m", "is_lost"),
        )
        yield f"{player}-sightings", columns, track.sight
    if track.pushes is not None:
        columns = (
            *("time_s", "duration_s", "x_m", "y_m"),
            *("impulse_x_n_s", "impulse_y_n_s"),
        )
        yield f"{player}-pushes", columns, track.pushes


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
