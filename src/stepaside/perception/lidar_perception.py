"""People in the scans of a lidar: clusters of returns, tracks, sightings."""

from math import atan2, cos, hypot, pi, sin

import numpy as np

from ..core.history import History
from ..core.poses import Array, Pose
from ..robots.description import RobotDescription
from ..robots.forward_kinematics import (
    ForwardKinematics,
    SpatialTorsoPose,
    torso_pose_on_foot,
)
from .images import LidarScan
from .measurement import RobotState, Sighting
from .target_selection import PeopleSelection
from .track import Observation, TargetTrack, Tracker

POSE_MEMORY = 1.0  # how long past poses are stored, in [s]
BINS = 360  # of bearings around the robot
FLOOR = 0.12  # height up to which returns are those of the floor, in [m]
TILT = 0.08  # error of the tilt of a torso that walks, in [rad]
CEILING = 2.0  # height of the tallest people, in [m]
JUMP = 0.3  # between ranges of two objects side by side, in [m]
GAP = 2  # bins without a return within an object
WIDEST = 0.9  # object that may be a person, in [m]
LEGS_APART = 0.5  # greatest distance of two parts of one person, in [m]
DEPTH = 0.1  # from the middle of the returns to the axis of a person, in [m]
DEVIATION = 0.05  # of the position of a person, in [m]
TALLNESS = 1.0  # assumed height of whatever a lidar detects, in [m]
HIDES = 0.3  # by which a nearer object hides a track, in [m]


class LidarPerception:
    """Pipeline from scans to sightings of the nearest person who walks."""

    def __init__(self, description: RobotDescription, far: float) -> None:
        self._kinematics = ForwardKinematics(description)
        self._far = far
        self._poses: History[SpatialTorsoPose] = History(POSE_MEMORY)
        self.tracker = Tracker()
        self._selection = PeopleSelection(self.tracker)

    def see(
        self,
        measurement: RobotState,
        pose_support_in_odometry: Pose,
        left_supports: bool,
        tilt: tuple[float, float],
    ) -> Sighting | None:
        """Return the sighting of the person who will be nearest, if any."""
        now = measurement.time
        posture = self._kinematics.posture(measurement.joint_positions)
        foot = 0 if left_supports else 1
        torso = torso_pose_on_foot(
            posture, foot, pose_support_in_odometry, tilt
        )
        self._poses.note(now, torso)
        for percept in measurement.percepts:
            if isinstance(percept, LidarScan):
                self._process(percept)
        x, y = torso.position_in_odometry[:2].tolist()
        track = self._selection.main(now, x, y)
        if track is None:
            return None
        place = Pose(x, y, torso.heading_in_odometry)
        return self._selection.sighting(track, now, place)

    def _process(self, scan: LidarScan) -> None:
        """Update the tracks with a scan."""
        torso = self._poses.at(scan.time)
        position, axes = torso.position_in_odometry, torso.axes_in_odometry
        points = position + scan.points_in_torso @ axes.T
        x, y = position[:2].tolist()
        ranges = nearest_ranges(standing_returns(points - (x, y, 0.0)))
        found = [
            Observation(
                scan.time,
                x + distance * cos(bearing),
                y + distance * sin(bearing),
                bearing,
                *(DEVIATION, DEVIATION),
                identified=False,
                ranged=True,
                height=TALLNESS,
            )
            for bearing, distance in find_people(ranges)
        ]
        updated = self.tracker.observe(found)
        for track in self.tracker.tracks:
            if track not in updated and self._shows(track, scan, ranges, x, y):
                track.record_frame(False)

    def _shows(
        self,
        track: TargetTrack,
        scan: LidarScan,
        ranges: Array,
        x: float,
        y: float,
    ) -> bool:
        """Return whether a scan from a position would show a track."""
        distance = track.distance_from(x, y, scan.time)
        bin_of = _bin(track.bearing_from(x, y, scan.time))
        return distance < self._far and ranges[bin_of] > distance - HIDES


def standing_returns(points: Array) -> Array:
    """Return (m, 2) points that belong to neither floor nor ceiling, [m]."""
    offsets, heights = points[:, :2], points[:, 2]
    floor = FLOOR + TILT * np.hypot(offsets[:, 0], offsets[:, 1])
    standing: Array = offsets[(heights > floor) & (heights < CEILING)]
    return standing


def nearest_ranges(offsets: Array) -> Array:
    """Return the nearest range [m] in each bin of bearings, inf if none."""
    ranges: Array = np.full(BINS, np.inf)
    bearings = np.arctan2(offsets[:, 1], offsets[:, 0])
    bins = np.floor(bearings / (2.0 * pi / BINS)).astype(int) % BINS
    np.minimum.at(ranges, bins, np.hypot(offsets[:, 0], offsets[:, 1]))
    return ranges


def find_people(ranges: Array) -> list[tuple[float, float]]:
    """Return bearing [rad] and distance [m] of objects as narrow as people."""
    width = 2.0 * pi / BINS
    narrow: list[tuple[float, float]] = []  # places (x, y)
    for group in _groups(ranges):
        bearings = (np.array(group) + 0.5) * width
        found = ranges[np.array(group) % BINS]
        x, y = found * np.cos(bearings), found * np.sin(bearings)
        span = hypot(x[-1] - x[0], y[-1] - y[0]) + width * float(found.mean())
        if span <= WIDEST:
            narrow.append((float(x.mean()), float(y.mean())))
    people: list[tuple[float, float]] = []
    while narrow:
        x0, y0 = narrow.pop()
        near = [
            (u, v) for u, v in narrow if hypot(u - x0, v - y0) < LEGS_APART
        ]
        narrow = [place for place in narrow if place not in near]
        parts = np.array([(x0, y0), *near]).mean(axis=0)
        bearing = atan2(parts[1], parts[0])
        people.append((bearing, float(np.hypot(*parts)) + DEPTH))
    return people


def _groups(ranges: Array) -> list[list[int]]:
    """Return the bins of each object, counted on over the last bin."""
    seen = np.flatnonzero(np.isfinite(ranges)).tolist()
    groups: list[list[int]] = []
    for i in seen:
        last = groups[-1][-1] if groups else None
        if last is not None and i - last <= GAP + 1:
            if abs(ranges[i] - ranges[last]) < JUMP:
                groups[-1].append(i)
                continue
        groups.append([i])
    if len(groups) > 1:
        first, last = groups[0][0], groups[-1][-1]
        near = first + BINS - last <= GAP + 1
        if near and abs(ranges[first] - ranges[last]) < JUMP:
            groups[-1] += [i + BINS for i in groups.pop(0)]
    return groups


def _bin(bearing: float) -> int:
    """Return the bin of a bearing, in [rad]."""
    return int(np.floor(bearing / (2.0 * pi / BINS))) % BINS
