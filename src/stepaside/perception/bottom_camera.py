"""Uses of the bottom camera of a head: feet of people, and floor close by."""

from collections.abc import Sequence
from typing import Protocol

from ..robots.body_pose import BodyPose
from .camera_pose import CameraPose
from .foot_tracking import FootDetector
from .images import ColourImage
from .near_floor import NearFloorMapper
from .target_selection import TargetSelection
from .track import Observation
from .tracker import Tracker


class BottomCameraUse(Protocol):
    """Use of the second camera of a head, which looks down.

    It alternates with the top camera, in whose images the colours of the
    floor are learnt.

    Attributes:
        seeks_opponent: Whether its observations may be of the opponent.
    """

    @property
    def seeks_opponent(self) -> bool:
        """Whether its observations may be of the opponent."""

    def wanted(self, body: BodyPose, *, lost: bool) -> bool:
        """Return whether the next image should come from this camera.

        Args:
            body: Pose of the body.
            lost: Whether the head searches, which needs the top camera.
        """

    def learn(self, image: ColourImage, camera: CameraPose) -> None:
        """Learn the colours of the floor from an image of the top camera.

        Args:
            image: The image.
            camera: Pose of the camera at its exposure.
        """

    def observe(
        self, image: ColourImage, camera: CameraPose
    ) -> Sequence[Observation]:
        """Evaluate an image of the bottom camera.

        Args:
            image: The image.
            camera: Pose of the camera at its exposure.
        """


class NearFloorMapping:
    """Mapping of floor that is too near for the depth camera."""

    seeks_opponent = False

    def __init__(
        self, mapper: NearFloorMapper, selection: TargetSelection
    ) -> None:
        """Map the floor beside the selected opponent."""
        self._mapper, self._selection = mapper, selection

    def wanted(self, body: BodyPose, *, lost: bool) -> bool:
        """Return true for every other image, unless the head searches."""
        return not lost and self._mapper.wanted()

    def learn(self, image: ColourImage, camera: CameraPose) -> None:
        """Learn the colours of the floor away from the opponent."""
        now, position = image.time, camera.position_torso_in_odometry
        main = self._selection.main(now, *position)
        self._mapper.learn(
            image, camera, None if main is None else main.position_at(now)
        )

    def observe(
        self, image: ColourImage, camera: CameraPose
    ) -> Sequence[Observation]:
        """Add the floor to the map; observe nothing."""
        self._mapper.show(image, camera)
        return ()


class FootTracking:
    """Tracking of people nearby by their feet."""

    seeks_opponent = True

    def __init__(
        self,
        detector: FootDetector,
        tracker: Tracker,
        selection: TargetSelection,
    ) -> None:
        """Detect the feet of the selected person."""
        self._detector = detector
        self._tracker, self._selection = tracker, selection

    def wanted(self, body: BodyPose, *, lost: bool) -> bool:
        """Return whether a person who has walked is close ahead."""
        x, y, _ = body.pose_torso_in_odometry
        main = self._selection.main(body.time, x, y)
        return self._detector.wanted(main, body.time, x, y, body.yaw)

    def learn(self, image: ColourImage, camera: CameraPose) -> None:
        """Learn the colours of the floor away from all tracks."""
        self._detector.learn(image, camera, self._tracker.tracks)

    def observe(
        self, image: ColourImage, camera: CameraPose
    ) -> Sequence[Observation]:
        """Observe feet."""
        return self._detector.observe(image, camera)
