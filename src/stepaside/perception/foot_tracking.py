"""The feet of who is near, by the lower camera of the head."""

from collections.abc import Sequence
from math import atan2, cos, hypot, sin

import numpy as np

from ..core.poses import Array
from .floor_colours import FloorColours, find_footings, floor_points
from .images import ColourImage
from .track import Observation, TargetTrack

CLOSE = 1.2  # distance of somebody whose feet are looked at, in [m]
ASIDE = 1.0  # yaw of the head up to which no arm is in view, in [rad]
SEEN = 0.5, 2.5  # distances of floor whose colours are learnt, in [m]
APART = 0.7  # from that floor to anybody, in [m]
TOES = 0.1  # from where feet begin to the axis above them, in [m]
ALONG, ACROSS = 0.12, 0.06  # deviations of that axis, in [m]


class FootDetector:
    """Learns the floor from far, and finds who stands on it close by.

    Within the near limit of the depth camera its image shows the bearing of
    somebody at best. The lower camera sees the feet there, and how far away
    they stand. It founds nobody and tells only of who was seen to walk, so
    that a stain on the floor moves no robot.
    """

    def __init__(self) -> None:
        """Know no floor."""
        self.colours = FloorColours()

    def wanted(
        self,
        track: TargetTrack | None,
        now: float,
        x: float,
        y: float,
        yaw: float,
    ) -> bool:
        """Whether the lower camera is of more use than the upper one.

        Args:
            track: Who counts, if anybody does.
            now: Time, in [s].
            x: Own place in odometry, in [m].
            y: Likewise.
            yaw: Of the head, in [rad].
        """
        if track is None or not track.walked or not self.colours.known:
            return False
        return abs(yaw) < ASIDE and track.away_from(x, y, now) < CLOSE

    def learn(
        self,
        image: ColourImage,
        place: Array,
        axes: Array,
        own: tuple[float, float],
        tracks: Sequence[TargetTrack],
    ) -> None:
        """Learn the floor in an image of the upper camera.

        Args:
            image: The image.
            place: Place of the camera in odometry, in [m]. Shape (3,).
            axes: Its axes as columns. Shape (3, 3).
            own: Own axis in odometry, in [m].
            tracks: Who stands on the floor.
        """
        points = floor_points(image, place, axes)
        away = np.hypot(points[..., 0] - own[0], points[..., 1] - own[1])
        floor = (away > SEEN[0]) & (away < SEEN[1])
        for track in tracks:
            x, y = track.place_at(image.time)
            apart = np.hypot(points[..., 0] - x, points[..., 1] - y)
            # Whoever stands there hides the floor behind as well.
            beyond = away > hypot(x - own[0], y - own[1]) - APART
            floor &= (apart > APART) & ~beyond
        self.colours.learn(image.pixels, floor)

    def observe(
        self,
        image: ColourImage,
        place: Array,
        axes: Array,
        own: tuple[float, float],
    ) -> list[Observation]:
        """Find whose feet an image of the lower camera shows.

        Args:
            image: The image.
            place: Place of the camera in odometry, in [m]. Shape (3,).
            axes: Its axes as columns. Shape (3, 3).
            own: Own axis in odometry, in [m].
        """
        found = find_footings(image, self.colours, place, axes, own)
        seen = []
        for foot in found:
            bearing = atan2(foot.y - own[1], foot.x - own[0])
            seen.append(
                Observation(
                    image.time,
                    foot.x + TOES * cos(bearing),
                    foot.y + TOES * sin(bearing),
                    bearing,
                    ALONG,
                    ACROSS,
                    False,
                    False,
                )
            )
        return seen
