"""Bottom camera of a head: detects feet and maps the floor close by."""

from collections.abc import Sequence
from math import atan2

from ..core.poses import Array, wrap_angle
from ..robots.body_pose import BodyPose
from ..robots.head import Mount
from .floor_map import FloorMap
from .foot_tracking import FootDetector
from .frame_report import FrameReport
from .images import ColourImage
from .near_floor import NearFloorMapper
from .observations import camera_of
from .track import Observation, TargetTrack

Point = tuple[float, float]  # in odometry, in [m]


class BottomCamera:
    """Second camera of a head, which looks down.

    It alternates with the top camera. It detects the feet of people nearby,
    and marks floor that is too near for the depth camera as free.
    """

    def __init__(
        self, mount: Mount | None, *, people: bool, floor: FloorMap | None
    ) -> None:
        """Set up the detectors for which there is a use.

        Args:
            mount: Mount on the head; None for a head without this camera.
            people: Whether people may approach.
            floor: Map of the floor, if there is one.
        """
        self._mount = mount
        exists = mount is not None
        self.feet = FootDetector() if people and exists else None
        self.near = (
            NearFloorMapper(floor) if floor is not None and exists else None
        )

    def wanted(
        self, body: BodyPose, main: TargetTrack | None, *, lost: bool
    ) -> bool:
        """Return whether the next image should come from this camera.

        Args:
            body: Pose of the body.
            main: Main track, if any.
            lost: Whether the head searches, which needs the top camera.
        """
        if not lost and self.near is not None and self.near.wanted():
            return True
        if self.feet is None:
            return False
        x, y, _ = body.torso
        return self.feet.wanted(main, body.time, x, y, body.yaw)

    def learn(
        self,
        image: ColourImage,
        position_camera_in_odometry: Array,
        axes_camera_in_odometry: Array,
        position_own_in_odometry: Point,
        tracks: Sequence[TargetTrack],
        main: TargetTrack | None,
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
            main: Main track, if any.
        """
        if self.feet is not None:
            self.feet.learn(
                image,
                position_camera_in_odometry,
                axes_camera_in_odometry,
                position_own_in_odometry,
                tracks,
            )
        if self.near is not None:
            position_opponent_in_odometry = (
                None if main is None else main.position_at(image.time)
            )
            self.near.learn(
                image,
                position_camera_in_odometry,
                axes_camera_in_odometry,
                position_own_in_odometry,
                position_opponent_in_odometry,
            )

    def see(
        self, image: ColourImage, body: BodyPose
    ) -> tuple[list[Observation], FrameReport]:
        """Evaluate an image of this camera.

        Args:
            image: The image.
            body: Pose of the body at its exposure.

        Returns:
            Observations of feet, and the report of the frame.
        """
        if self._mount is None:
            return [], FrameReport(image, (), sought=False)
        own = body.torso[:2]
        position, axes = camera_of(body, self._mount)
        if self.near is not None:
            self.near.show(
                image,
                position,
                axes,
                own,
            )
        if self.feet is None:
            return [], FrameReport(image, (), sought=False)
        observations = self.feet.observe(
            image,
            position,
            axes,
            own,
        )
        ahead = atan2(axes[1, 0], axes[0, 0])
        azimuths = tuple(
            wrap_angle(each.bearing - ahead) for each in observations
        )
        return observations, FrameReport(image, azimuths)
