"""Detection of the feet of people nearby, by the bottom camera."""

from collections.abc import Sequence
from math import atan2, cos, sin

from .camera_pose import CameraPose
from .floor_colours import (
    FloorColours,
    detect_feet,
    floor_in_view,
    floor_points,
)
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
        camera: CameraPose,
        tracks: Sequence[TargetTrack],
    ) -> None:
        """Learn the colours of the floor from an image of the top camera.

        Args:
            image: The image.
            camera: Pose of the camera at its exposure.
            tracks: All tracks; the floor around them is left out.
        """
        floor = floor_in_view(
            floor_points(image, camera),
            camera,
            LEARNT,
            [track.position_at(image.time) for track in tracks],
            margin=MARGIN,
            depth=MARGIN,
        )
        self.colours.learn(image.pixels, floor)

    def observe(
        self, image: ColourImage, camera: CameraPose
    ) -> list[Observation]:
        """Detect feet in an image of the bottom camera.

        Args:
            image: The image.
            camera: Pose of the camera at its exposure.
        """
        own_x, own_y = camera.position_torso_in_odometry
        observations = []
        for contact in detect_feet(image, camera, self.colours):
            bearing = atan2(
                contact.y_in_odometry - own_y, contact.x_in_odometry - own_x
            )
            observations.append(
                Observation(
                    image.time,
                    contact.x_in_odometry + TOES * cos(bearing),
                    contact.y_in_odometry + TOES * sin(bearing),
                    bearing,
                    ALONG,
                    ACROSS,
                    False,
                    False,
                )
            )
        return observations
