"""Conversion of the rows recorded by a player at a robot into a run."""

from pathlib import Path

import numpy as np

from ..core.poses import Array
from ..drivers.joint.safety import RobotState
from ..drivers.row_file import HEADER, ROWS
from ..drivers.velocity.velocity_loop import DrivingState
from ..robots.description import load_robot
from ..theory.unicycle.circle_fit import fit_circle
from .array_checks import check_times, check_tracks
from .duel_circle import cycle_mean, distance_between
from .duel_settings import PLAYERS
from .outcome import Outcome
from .play_joint_path import OdometryPath
from .play_rows import NOTES, PlayedRows, read_played
from .play_settings import PlaySettings
from .play_sightings import sight_table, sightings_in, track_of_other
from .play_summary import Change, PlaySummary
from .run import PlayRun
from .trajectory import Trajectory

MAX_CHANGES = 2000  # of state, in a summary
MIN_TURN = 0.5  # of a path to which a circle can be fitted, in [rad]
CUT_OFF = "the record was cut off"


def has_play_rows(folder: Path) -> bool:
    """Return whether a folder holds rows of a player, finished or not."""
    return all((folder / name).is_file() for name in (HEADER, ROWS, NOTES))


def run_of_play(
    folder: Path,
    settings: PlaySettings,
    outcome: Outcome = Outcome.FAILED,
    message: str = CUT_OFF,
) -> PlayRun:
    """Convert the rows of a player into a run.

    Args:
        folder: Folder of the rows.
        settings: Settings of the player.
        outcome: How the play ended.
        message: Reason for the end, as text.

    Raises:
        ConfigurationError: If there are no valid rows.
        ValueError: If a file is too long, or not a regular file.
        OSError: If a file cannot be read.
    """
    name = folder.resolve().name
    rows = read_played(folder)
    times, found = rows.times[rows.sampled], sightings_in(rows)
    own = _own(rows, settings, sight_table(found))
    other = track_of_other(found, times, own.unicycle)
    tracks = {settings.role: own}
    if other is not None:
        both = tracks | {settings.other: other}
        tracks = {player: both[player] for player in PLAYERS}
    check_times(times, name)
    check_tracks(tracks, len(times), name)
    return PlayRun(
        name=name,
        settings=settings,
        outcome=outcome,
        message=message,
        duration=float(times[-1]),
        times=times,
        tracks=tracks,
        summary=_summary(rows, settings, times, tracks),
    )


def _own(rows: PlayedRows, settings: PlaySettings, sight: Array) -> Trajectory:
    """Return the trajectory of the player itself."""
    if rows.moves_joints:
        path = OdometryPath(rows, load_robot(settings.robot))
        return path.track(settings.gait, sight)
    sampled = rows.sampled
    torso = rows.columns["pose"][sampled].copy()
    torso[:, 2] = np.unwrap(torso[:, 2])
    com = torso.copy()
    com[:, 2] = 0.0
    commands = [rows.columns[name][sampled] for name in ("wanted", "velocity")]
    return Trajectory(
        com=com, torso=torso, sight=sight, command=np.hstack(commands)
    )


def _summary(
    rows: PlayedRows,
    settings: PlaySettings,
    times: Array,
    tracks: dict[str, Trajectory],
) -> PlaySummary:
    states = RobotState if rows.moves_joints else DrivingState
    walking = rows.columns["state"] == list(states).index(states.WALKING)
    passed = np.diff(rows.times, prepend=0.0)
    walked = float(passed[walking].sum())
    seen = ~np.isnan(rows.columns["sighting"][:, 0])
    late = _last_third(rows, walking)[rows.sampled]
    own = tracks[settings.role]
    distance = None
    if len(tracks) > 1:
        distance = distance_between(*(t.unicycle for t in tracks.values()))
    smooth = np.column_stack(
        [cycle_mean(c, times, settings.cycle) for c in own.unicycle[:, :2].T]
    )
    steps, spent = None, np.zeros(0)
    if rows.moves_joints:
        begun = rows.columns["begun"]
        steps = int((~np.isnan(begun[:, 0])).sum())
        spent = begun[~np.isnan(begun[:, 5]), 5]
    nearest = rows.columns["sighting"][seen, 2]
    return PlaySummary(
        role=settings.role,
        language=settings.language,
        walking_s=walked,
        steps=steps,
        path_length_m=float(np.hypot(*np.diff(smooth, axis=0).T).sum()),
        radius_m=_radius(smooth[late], own.unicycle[late, 2]),
        distance_m=None
        if distance is None or not late.any()
        else float(distance[late].mean()),
        closest_m=float(nearest.min()) if len(nearest) else None,
        seen_share=float(passed[walking & seen].sum() / walked)
        if walked > 0.0
        else None,
        plan_time_us=1e6 * float(np.median(spent)) if len(spent) else None,
        changes=_changes(rows),
    )


def _radius(path: Array, headings: Array) -> float | None:
    """Return the radius of a path, in [m]; None if it turns too little."""
    if len(path) < 3 or np.ptp(headings) < MIN_TURN:
        return None
    return fit_circle(path)[1]


def _last_third(rows: PlayedRows, walking: Array) -> Array:
    """Return a mask of the rows in the last third of walking."""
    at = np.flatnonzero(walking)
    late = np.zeros(len(walking), dtype=bool)
    late[at[2 * len(at) // 3 :]] = True
    return late


def _changes(rows: PlayedRows) -> tuple[Change, ...]:
    times, changes = rows.times, rows.changes[:MAX_CHANGES]
    return tuple(
        Change(float(times[change.tick]), change.state, change.reason)
        for change in changes
        if 0 <= change.tick < len(times)
    )
