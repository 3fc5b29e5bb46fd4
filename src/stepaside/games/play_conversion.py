"""Rows recorded by a player at a robot, and their conversion into a run."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import cos, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.entries import load_entries
from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose
from ..core.rotations import quaternion_of, rotation
from ..drivers.play_log import METADATA, ROWS, columns_in
from ..drivers.safety import SafetyState
from ..drivers.velocity_loop import DrivingState
from ..perception.attitude import AttitudeFilter
from ..planning import GaitSettings
from ..robots.description import RobotDescription, load_robot
from ..robots.forward_kinematics import (
    ForwardKinematics,
    MeasuredPosture,
    SpatialTorsoPose,
    torso_pose_on_foot,
)
from .evaluation import measure
from .game import Outcome
from .play_settings import PlaySettings
from .player_settings import PLAYERS, PURSUER
from .run import Run
from .summary import PlanningSummary, PlaySummary, StateChange, Summary
from .trajectory import ON_FLOOR, Trajectory

PERIOD = 0.02  # approximate smallest period of the samples of a run, in [s]
MAX_GAP = 10.0  # between ticks of one clock, in [s]
DEFAULT_TICK = 0.012  # of rows whose times do not advance, in [s]
MAX_CHANGES = 2000  # of state, in a summary
SAME = 1e-6  # tolerance within which times are of one sighting, in [s]
ACCELEROMETER_GAIN = 0.5  # of the attitude filter, in [1/s]
MIN_FOOT_FORCE = 1.0  # below which the ZMP is unknown, in [N]
CUT_OFF = "the record was cut off"


@dataclass(frozen=True, slots=True, eq=False)
class PlayedRows:
    """Rows of a player, with a monotonic clock."""

    columns: Mapping[str, Array]  # by name: (rows,) or (rows, width)
    times: Array  # since the record began, in [s]
    changes: tuple[StateChange, ...] = ()

    @property
    def moves_joints(self) -> bool:
        """Whether joints were commanded, not velocities."""
        return "joint_positions" in self.columns

    @property
    def offset(self) -> Array:
        """Record time minus the robot's time, in [s]. Shape (rows,)."""
        offset: Array = self.times - self.columns["times_s"]
        return offset

    @property
    def sampled(self) -> NDArray[np.intp]:
        """Indices of the rows that become samples: periodic, and the last."""
        passed = np.diff(self.times)
        new = np.flatnonzero(np.concatenate([[True], passed > 0.0]))
        gap = float(np.median(np.diff(self.times[new], append=np.inf)))
        chosen = new[:: max(1, round(PERIOD / max(gap, 1e-3)))]
        has_last = chosen[-1] == new[-1]
        return chosen if has_last else np.append(chosen, new[-1:])


def read_played(folder: Path) -> PlayedRows:
    """Read the rows of a player, which may still be running."""
    notes = load_entries(folder / METADATA)
    found = columns_in((folder / ROWS).read_bytes(), notes["columns"])
    if not len(found["times_s"]):
        raise ValueError(f"{ROWS} has no rows")
    times = monotonic_times(found["times_s"])
    changes = [
        StateChange(float(times[each["tick"]]), each["state"], each["reason"])
        for each in notes["changes"][:MAX_CHANGES]
        if each["tick"] < len(times)  # the last rows may be lost
    ]
    return PlayedRows(found, times, tuple(changes))


def monotonic_times(times: Array) -> Array:
    """Convert robot times to monotonic times since the first row.

    A robot's clock restarts with each walk and after each lost connection.
    At a restart one tick is taken to have passed.
    """
    passed = np.diff(times)
    with np.errstate(invalid="ignore"):
        regular = (passed >= 0.0) & (passed < MAX_GAP)
        positive = passed[regular & (passed > 0.0)]
    tick = float(np.median(positive)) if len(positive) else DEFAULT_TICK
    steps = np.where(regular, passed, tick)
    elapsed: Array = np.concatenate([[0.0], np.cumsum(steps)])
    return elapsed


def has_play_rows(folder: Path) -> bool:
    """Return whether a folder holds rows of a player, finished or not."""
    return all((folder / name).is_file() for name in (ROWS, METADATA))


def run_of_play(
    folder: Path,
    settings: PlaySettings,
    outcome: Outcome = Outcome.FAILED,
    message: str = CUT_OFF,
) -> Run:
    """Convert the rows of a player into a run."""
    name, rows = folder.resolve().name, read_played(folder)
    times, found = rows.times[rows.sampled], sightings_in(rows)
    lost, unknown = np.isnan(found[:, 1]), np.full((len(found), 2), np.nan)
    sight = np.column_stack([found[:, 0], found[:, 2:], unknown, lost])
    own = _own(rows, settings, sight)
    other = opponent_trajectory(found, times, own.unicycle)
    tracks = {settings.role: own}
    if other is not None:
        both = (own, other) if settings.role == PURSUER else (other, own)
        tracks = dict(zip(PLAYERS, both, strict=True))
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
    commands = [rows.columns[name][sampled] for name in ("wanted", "velocity")]
    command, com = np.hstack(commands), torso * ON_FLOOR
    return Trajectory(com=com, torso=torso, sight=sight, command=command)


def _summary(rows: PlayedRows, run: Run) -> Summary:
    """Summarise a play by the player's own odometry and sightings."""
    states = SafetyState if rows.moves_joints else DrivingState
    walking = rows.columns["state"] == list(states).index(states.WALKING)
    passed = np.diff(rows.times, prepend=0.0)
    walked = float(passed[walking].sum())
    rank = np.cumsum(walking)  # the last third of walking
    late = walking & (rank > 2 * rank[-1] // 3)
    sightings = rows.columns["sighting"]
    seen = ~np.isnan(sightings[:, 0])
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
        measure(run, late[rows.sampled]),
        min_distance_m=float(sightings[seen, 2].min()) if seen.any() else None,
        planning=planning,
        play=PlaySummary(walked, rows.changes),
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


def opponent_trajectory(
    found: Array, times: Array, own: Array
) -> Trajectory | None:
    """Return the trajectory of the opponent's last sightings, in odometry.

    Args:
        found: Sightings of :func:`sightings_in`. Shape (k, 4).
        times: Times of the samples, in [s]. Shape (n,).
        own: Poses of the player in odometry at these times. Shape (n, 3).
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
    return Trajectory(com=torso * ON_FLOOR, torso=torso)


class OdometryPath:
    """Reconstruction of a robot's motion from its recorded rows.

    In each row the robot stands on the support foot of its controller, with
    the tilt of its IMU and the measured joint angles; on learned legs its CoM
    is at the place of their odometry, and its lowest sole on the floor. Each
    controller that was started has its own odometry, whose origin is midway
    between the last feet positions in the odometry of the controller before
    it.
    """

    def __init__(
        self, rows: PlayedRows, description: RobotDescription, tilts: Array
    ) -> None:
        """Take rows, and roll and pitch of the torso in each, in [rad]."""
        self._rows, self._columns = rows, rows.columns
        self._forward = ForwardKinematics(description)
        self._tree = tree = self._forward.tree
        self._moved, self._fixed = tree.moved_by(
            tree.motors, description.standing
        )
        joints = rows.columns["joint_positions"].shape[1]
        if joints != len(tree.motors):
            raise ConfigurationError(
                f"a player of {description.name} must measure "
                f"{len(tree.motors)} joints, got {joints}"
            )
        self._sensors = self._forward.force_sensors()
        self._tilts = tilts

    def track(self, gait: GaitSettings, sight: Array) -> Trajectory:
        """Return the trajectory in the odometry of the first controller."""
        columns, frames = self._columns, self._frames()
        references = ("com_reference", "zmp_reference")
        samples = list[dict[str, Any]]()
        for row in self._rows.sampled.tolist():
            frame = frames[float(columns["mind"][row])]
            posture, body = self._stand(row, frame)
            origin, axes = body.position_in_odometry, body.axes_in_odometry
            heading = body.heading_in_odometry
            com = origin + axes @ posture.position_com_in_torso
            lead = gait.zmp_forward * np.array([cos(heading), sin(heading)])
            values = {
                "com": com,
                "torso": [*origin[:2], heading],
                "place": [*(com[:2] - lead), heading],
                "qpos": self._qpos(row, body),
                "zmp": self._zmp(row, posture, body),
            }
            for name in references:
                values[name] = frame.transform_points(columns[name][row])
            samples.append(values)
        arrays: dict[str, Any] = {
            name: np.array([own[name] for own in samples])
            for name in samples[0]
        }
        for name in ("gyro", "accelerometer", "foot_forces"):
            arrays[name] = columns[name][self._rows.sampled]
        for name in (*references, "foot_forces"):
            if np.isnan(arrays[name]).all():  # learned legs need none
                del arrays[name]
        for name in ("place", "torso"):
            arrays[name][:, 2] = np.unwrap(arrays[name][:, 2])
        arrays["qpos"] = arrays["qpos"].astype(np.float32)
        return Trajectory(
            **arrays, landings=self._landings(frames), sight=sight
        )

    def _frames(self) -> dict[float, Pose]:
        """Return the odometry of each controller in that of the first."""
        controllers = self._columns["mind"]
        changes = np.flatnonzero(np.diff(controllers))
        last_rows = np.append(changes, len(controllers) - 1)
        frames, frame = {}, Pose(0.0, 0.0, 0.0)
        for row in last_rows.tolist():
            frames[float(controllers[row])] = frame
            posture, body = self._stand(row, frame)
            x, y, _ = (
                body.position_in_odometry
                + body.axes_in_odometry
                @ posture.positions_feet_in_torso.mean(axis=0)
            ).tolist()
            frame = Pose(x, y, body.heading_in_odometry)
        return frames

    def _stand(
        self, row: int, frame: Pose
    ) -> tuple[MeasuredPosture, SpatialTorsoPose]:
        x, y, heading, side = self._columns["support"][row].tolist()
        measured = self._columns["joint_positions"][row].copy()
        posture = self._forward.posture(measured)
        support = frame.compose(Pose(x, y, heading))
        roll, pitch = self._tilts[row].tolist()
        if not np.isnan(side):
            foot, tilt = 0 if side > 0.0 else 1, (roll, pitch)
            return posture, torso_pose_on_foot(posture, foot, support, tilt)
        # On learned legs the support is the place of the CoM.
        axes = rotation(roll, pitch, support.theta)
        com = axes @ posture.position_com_in_torso
        lowest = float((self._corners(posture) @ axes.T)[:, 2].min())
        place = np.array([support.x - com[0], support.y - com[1], -lowest])
        return posture, SpatialTorsoPose(place, axes, support.theta)

    def _qpos(self, row: int, body: SpatialTorsoPose) -> Array:
        """Return position and quaternion of the torso, then all joints."""
        measured = self._columns["joint_positions"][row].tolist()
        known = {n: measured[i] for n, i in self._moved.items()} | self._fixed
        joints = [known[name] for name in self._tree.joints]
        roll, pitch = self._tilts[row].tolist()
        quaternion = quaternion_of(roll, pitch, body.heading_in_odometry)
        return np.array([*body.position_in_odometry, *quaternion, *joints])

    def _zmp(
        self, row: int, posture: MeasuredPosture, body: SpatialTorsoPose
    ) -> Array:
        """Return the center of the foot forces; NaN without any force."""
        forces = self._columns["foot_forces"][row]
        total = float(forces.sum())
        if not total > MIN_FOOT_FORCE:
            return np.full(2, np.nan)
        center_in_torso = forces @ self._corners(posture) / total
        center: Array = body.axes_in_odometry @ center_in_torso
        return (body.position_in_odometry + center)[:2]

    def _corners(self, posture: MeasuredPosture) -> Array:
        """Return the force sensors in the torso frame, in [m]. (8, 3)."""
        flat = np.column_stack([self._sensors, np.zeros(len(self._sensors))])
        return np.concatenate(
            [
                posture.positions_feet_in_torso[i]
                + flat[4 * i : 4 * i + 4] @ posture.axes_feet_in_torso[i].T
                for i in range(2)
            ]
        )

    def _landings(self, frames: dict[float, Pose]) -> Array:
        begun, controllers = self._columns["begun"], self._columns["mind"]
        landings = []
        for row in np.flatnonzero(~np.isnan(begun[:, 0])).tolist():
            time, side, x, y, heading, _ = begun[row].tolist()
            frame = frames[float(controllers[row])]
            landing = frame.compose(Pose(x, y, heading))
            time += float(self._rows.offset[row])
            landings.append([time, side, *landing])
        return np.array(landings, dtype=np.float64).reshape(-1, 5)


def estimate_tilts(rows: PlayedRows) -> Array:
    """Estimate roll and pitch of the torso in each row from its IMU [rad]."""
    attitude = AttitudeFilter(ACCELEROMETER_GAIN, 0.0, calibration=0.0)
    gyro, force = rows.columns["gyro"], rows.columns["accelerometer"]
    passed = np.diff(rows.times, prepend=0.0).tolist()
    tilts = np.zeros((len(gyro), 2))
    for row, duration in enumerate(passed):
        attitude.update(gyro[row], force[row], (0.0, 0.0), duration)
        tilts[row] = attitude.roll, attitude.pitch
    return tilts
