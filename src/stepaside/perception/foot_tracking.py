"""Detection of the feet of people nearby, by the bottom camera."""

from collections.abc import Sequence
from math import atan2, cos, hypot, sin

import numpy as np

from ..core.poses import Array
from .floor_colours import FloorColours, detect_feet, floor_points
from .images import ColourImage
from .track import Observation, TargetTrack

CLOSE = 1.2  # distance within which feet are looked for, in [m]
MAX_YAW = 1.0  # of the head, beyond which arms are in view, in [rad]
LEARNT = 0.5, 2.5  # distances of floor whose colours are learnt, in [m]
MARGIN = 0.7  # from that floor to any track, in [m]
TOES = 0.1  # from the near edge of feet to the axis of a person, in [m]
# Standard deviations of that axis along and across the bearing, in [m].
ALONG = 0.12
ACROSS = 0.06


class FootDetector:
    """Detector of feet on a floor whose colours it learns from a distance.

    Within the near limit of the depth camera, depth gives a bearing at best.
    The bottom camera shows feet there, and their distance. Its observations
    start no track and update only tracks that have walked, so that a stain
    on the floor does not make the robot move.
    """

    def __init__(self) -> None:
        """Start without colours of the floor."""
        self.colours = FloorColours()

    def wanted(
        self,
        track: TargetTrack | None,
        now: float,
        x: float,
        y: float,
        yaw: float,
    ) -> bool:
        """Return whether to use the bottom camera instead of the top one.

        Args:
            track: Main track, if any.
            now: Time, in [s].
            x: Own x in odometry, in [m].
            y: Own y in odometry, in [m].
            yaw: Yaw of the head, in [rad].
        """
        if track is None or not track.has_walked or not self.colours.known:
            return False
        return abs(yaw) < MAX_YAW and track.distance_from(x, y, now) < CLOSE

    def learn(
        self,
        image: ColourImage,
        position_camera_in_odometry: Array,
        axes_camera_in_odometry: Array,
        position_own_in_odometry: tuple[float, float],
        tracks: Sequence[TargetTrack],
    ) -> None:
        """Learn the colours of the floor from an image of the top camera.

        Args:
            image: The image.
            position_camera_in_odometry: Position of the camera, in [m].
                Shape (3,).
            axes_camera_in_odometry: Its axes (forward, left, up) as columns.
                Shape (3, 3).
            position_own_in_odometry: Position of the robot, in [m].
            tracks: All tracks; the floor around them is left out.
        """
        points = floor_points(
            image, position_camera_in_odometry, axes_camera_in_odometry
        )
        distances = np.hypot(
            points[..., 0] - position_own_in_odometry[0],
            points[..., 1] - position_own_in_odometry[1],
        )
        floor = (distances > LEARNT[0]) & (distances < LEARNT[1])
        for track in tracks:
            x, y = track.position_at(image.time)
            apart = np.hypot(points[..., 0] - x, points[..., 1] - y)
            # A person also hides the floor behind.
            beyond = (
                distances
                > hypot(
                    x - position_own_in_odometry[0],
                    y - position_own_in_odometry[1],
                )
                - MARGIN
            )
            floor &= (apart > MARGIN) & ~beyond
        self.colours.learn(image.pixels, floor)

    def observe(
        self,
        image: ColourImage,
        position_camera_in_odometry: Array,
        axes_camera_in_odometry: Array,
        position_own_in_odometry: tuple[float, float],
    ) -> list[Observation]:
        """Detect feet in an image of the bottom camera.

        Args:
            image: The image.
            position_camera_in_odometry: Position of the camera, in [m].
                Shape (3,).
            axes_camera_in_odometry: Its axes (forward, left, up) as columns.
                Shape (3, 3).
            position_own_in_odometry: Position of the robot, in [m].
        """
        contacts = detect_feet(
            image,
            self.colours,
            position_camera_in_odometry,
            axes_camera_in_odometry,
            position_own_in_odometry,
        )
        observations = []
        for contact in contacts:
            bearing = atan2(
                contact.y - position_own_in_odometry[1],
                contact.x - position_own_in_odometry[0],
            )
            observations.append(
                Observation(
                    image.time,
                    contact.x + TOES * cos(bearing),
                    contact.y + TOES * sin(bearing),
                    bearing,
                    ALONG,
                    ACROSS,
                    False,
                    False,
                )
            )
        return observations
