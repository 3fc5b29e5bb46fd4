"""Conversion of the rows recorded by a player at a robot into a run."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from ..drivers.play_log import METADATA, ROWS
from ..drivers.safety import SafetyState
from ..drivers.velocity_loop import DrivingState
from ..robots.description import load_robot
from .duel_settings import PLAYERS
from .evaluation import measure
from .outcome import Outcome
from .play_joint_path import OdometryPath, estimate_tilts
from .play_rows import PlayedRows, read_played
from .play_settings import PlaySettings
from .run import Run
from .summary import PlanningSummary, PlaySummary, StateChange, Summary
from .trajectory import Trajectory, check_record

MAX_CHANGES = 2000  # of state, in a summary
SAME = 1e-6  # tolerance within which times are of one sighting, in [s]
CUT_OFF = "the record was cut off"


def has_play_rows(folder: Path) -> bool:
    """Return whether a folder holds rows of a player, finished or not."""
    return all((folder / name).is_file() for name in (ROWS, METADATA))


def run_of_play(
    folder: Path,
    settings: PlaySettings,
    outcome: Outcome = Outcome.FAILED,
    message: str = CUT_OFF,
) -> Run:
    """Convert the rows of a player into a run.

    Raises:
        ConfigurationError: If there are no valid rows.
        ValueError: If a file is too long, or not a regular file.
        OSError: If a file cannot be read.
    """
    name = folder.resolve().name
    rows = read_played(folder)
    times, found = rows.times[rows.sampled], sightings_in(rows)
    own = _own(rows, settings, sight_table(found))
    other = opponent_trajectory(found, times, own.unicycle)
    tracks = {settings.role: own}
    if other is not None:
        both = tracks | {settings.other: other}
        tracks = {player: both[player] for player in PLAYERS}
    check_record(times, tracks, name)
    run = Run(
        name=name,
        settings=settings,
        outcome=outcome,
        message=message,
        duration=float(times[-1]),
        times=times,
        tracks=tracks,
    )
    return replace(run, summary=_summary(rows, run))


def _own(rows: PlayedRows, settings: PlaySettings, sight: Array) -> Trajectory:
    """Return the trajectory of the player itself."""
    if rows.moves_joints:
        robot = load_robot(settings.robot)
        path = OdometryPath(rows, robot, estimate_tilts(rows))
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


def _summary(rows: PlayedRows, run: Run) -> Summary:
    """Summarise a play by the player's own odometry and sightings."""
    states = SafetyState if rows.moves_joints else DrivingState
    walking = rows.columns["state"] == list(states).index(states.WALKING)
    passed = np.diff(rows.times, prepend=0.0)
    walked = float(passed[walking].sum())
    sightings = rows.columns["sighting"]
    seen = ~np.isnan(sightings[:, 0])
    share = float(passed[walking & seen].sum() / walked) if walked else None
    planning = None
    if rows.moves_joints:
        begun = rows.columns["begun"]
        spent = 1e6 * begun[~np.isnan(begun[:, 5]), 5]
        planning = PlanningSummary(
            steps=int((~np.isnan(begun[:, 0])).sum()),
            replans=len(spent),
            median_us=float(np.median(spent)) if len(spent) else None,
        )
    return replace(
        measure(run, _last_third(walking)[rows.sampled]),
        min_distance_m=float(sightings[seen, 2].min()) if seen.any() else None,
        planning=planning,
        play=PlaySummary(walked, share, _changes(rows)),
    )


def _last_third(walking: Array) -> NDArray[np.bool_]:
    """Return a mask of the rows in the last third of walking."""
    at = np.flatnonzero(walking)
    late = np.zeros(len(walking), dtype=bool)
    late[at[2 * len(at) // 3 :]] = True
    return late


def _changes(rows: PlayedRows) -> tuple[StateChange, ...]:
    times, changes = rows.times, rows.changes[:MAX_CHANGES]
    return tuple(
        StateChange(float(times[change.tick]), change.state, change.reason)
        for change in changes
        if 0 <= change.tick < len(times)
    )


def sightings_in(rows: PlayedRows) -> Array:
    """Extract each new sighting and each loss of the opponent.

    Returns:
        Time of arrival [s], time of measurement [s], bearing [rad] and
        distance [m]; NaN after arrival where the opponent was lost. Shape
        (k, 4).
    """
    sightings = rows.columns["sighting"]
    taken = sightings[:, 0] + rows.offset
    lost = np.isnan(taken)
    before = np.concatenate([[np.nan], taken[:-1]])
    with np.errstate(invalid="ignore"):
        new = ~lost & ~(np.abs(taken - before) < SAME)
    gone = lost & ~np.isnan(before)
    chosen = np.flatnonzero(new | gone)
    return np.column_stack(
        [rows.times[chosen], taken[chosen], sightings[chosen, 1:]]
    )


def sight_table(found: Array) -> Array:
    """Convert sightings to the array of a run, with the truth unknown.

    Args:
        found: Sightings of :func:`sightings_in`. Shape (k, 4).

    Returns:
        Array ``sight`` of :class:`Trajectory`. Shape (k, 6).
    """
    unknown = np.full((len(found), 2), np.nan)
    lost = np.isnan(found[:, 1]).astype(float)
    return np.column_stack([found[:, 0], found[:, 2:], unknown, lost])


def opponent_trajectory(
    found: Array, times: Array, own: Array
) -> Trajectory | None:
    """Return the trajectory of the opponent's last sightings.

    Args:
        found: Sightings of :func:`sightings_in`. Shape (k, 4).
        times: Times of the samples, in [s]. Shape (n,).
        own: Poses (x, y, heading) of the player in odometry, in [m] and
            [rad]. Shape (n, 3).

    Returns:
        Trajectory in odometry; None without a sighting.
    """
    sightings = found[~np.isnan(found[:, 1])]
    if not len(sightings):
        return None
    arrived, taken, bearing, distance = sightings.T
    x, y, heading = (np.interp(taken, times, column) for column in own.T)
    toward = heading + bearing
    rows = np.column_stack(
        [
            x + distance * np.cos(toward),
            y + distance * np.sin(toward),
            np.unwrap(toward + np.pi),
        ]
    )
    # Before its first sighting the opponent is put at that sighting.
    newest = np.searchsorted(arrived, times + 1e-9, side="right") - 1
    torso = rows[np.maximum(newest, 0)]
    com = torso.copy()
    com[:, 2] = 0.0
    return Trajectory(com=com, torso=torso)
