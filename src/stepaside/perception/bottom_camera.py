"""What the lower camera of a head shows: feet, and the floor close by."""

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

Own = tuple[float, float]  # axis of the robot in odometry, in [m]


class BottomCamera:
    """The second camera of a head, which looks down.

    It takes turns with the upper one. It finds the feet of people who are
    near, and shows a map the floor that the depth camera is too near to see.
    """

    def __init__(
        self, mount: Mount | None, *, people: bool, floor: FloorMap | None
    ) -> None:
        """Use it, if there is one.

        Args:
            mount: On the head; None for a head that has none.
            people: Whether people come.
            floor: Map of the floor, if one is kept.
        """
        self._mount = mount
        there = mount is not None
        self.feet = FootDetector() if people and there else None
        self.near = (
            NearFloorMapper(floor) if floor is not None and there else None
        )

    def wanted(
        self, body: BodyPose, main: TargetTrack | None, *, lost: bool
    ) -> bool:
        """Whether the next image is to be its own.

        Args:
            body: Where the body is.
            main: Who counts, if anybody does.
            lost: Whether somebody is looked for, which the upper camera
                does.
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
        place: Array,
        axes: Array,
        own: Own,
        tracks: Sequence[TargetTrack],
        main: TargetTrack | None,
    ) -> None:
        """Learn what the floor looks like, from an upper image.

        Args:
            image: The image.
            place: Place of the upper camera in odometry, in [m]. Shape (3,).
            axes: Its axes as columns. Shape (3, 3).
            own: Own axis in odometry, in [m].
            tracks: Who stands on the floor.
            main: Who of them counts, if anybody does.
        """
        if self.feet is not None:
            self.feet.learn(image, place, axes, own, tracks)
        if self.near is not None:
            other = None if main is None else main.place_at(image.time)
            self.near.learn(image, place, axes, own, other)

    def see(
        self, image: ColourImage, body: BodyPose
    ) -> tuple[list[Observation], FrameReport]:
        """What an image of it shows, and in which directions.

        Args:
            image: The image.
            body: Where the body was when it was taken.
        """
        if self._mount is None:
            return [], FrameReport(image, (), sought=False)
        own = body.torso[:2]
        place, axes = camera_of(body, self._mount)
        if self.near is not None:
            self.near.show(image, place, axes, own)
        if self.feet is None:
            return [], FrameReport(image, (), sought=False)
        seen = self.feet.observe(image, place, axes, own)
        ahead = atan2(axes[1, 0], axes[0, 0])
        azimuths = tuple(wrap_angle(each.bearing - ahead) for each in seen)
        return seen, FrameReport(image, azimuths)
