"""Cameras of robots: their images, and sightings by those that say where."""

import logging
from concurrent.futures import Future
from math import isfinite, pi
from pathlib import Path
from time import monotonic, sleep
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.errors import FAILURES, shown
from ..core.history import History
from ..core.poses import Pose, wrap_angle
from ..core.rotations import rotation
from ..perception.body_pose import BodyPose
from ..perception.camera_model import CameraModel
from ..perception.images import ColourImage
from ..perception.measurement import RobotState
from .method_thread import MethodThread, SessionLost
from .robot import CameraImage, CameraMount

if TYPE_CHECKING:
    from ..perception.pipeline import Perception
    from .robot_session import RobotSession

SIZES = 8, 4096  # of an image, in [px]
OLDEST = 0.5  # age of an image that is not used, in [s]
LEAD = 0.1  # by which its time may be ahead of the reports', in [s]
IMAGE_SILENCE = 0.5  # without an image before the robot must stand, in [s]
HIGHEST = 4.0  # plausible height of a camera, in [m]
PATIENCE = 0.1  # of a camera without images, in [s]
MEMORY = 1.0  # how long poses are stored, to place images in time, in [s]
DEVICE = "/dev/video"
log = logging.getLogger(__name__)


class RobotCamera:
    """Images of a camera, which is read in a thread as it may wait."""

    def __init__(
        self,
        camera: Any,
        *,
        needs_mount: bool = False,
        apart: bool = False,
    ) -> None:
        """Begin without an image.

        The camera has image() and close(). A camera apart from the robot is
        closed with this object, and its times are those of this computer;
        a robot is connected already. Some images must bring the camera's
        pose.
        """
        self._camera, self._methods = camera, MethodThread(camera)
        self._name = self._methods.name_of("image")
        self._needs_mount, self._apart = needs_mount, apart
        self._reading: Future[Any] | None = None
        self._last = float("nan")
        self._newest: float | None = None  # valid image, on our clock
        self._began = self._methods.clock()
        self._fault = ""

    def take(self, now: float) -> CameraImage | None:
        """Return an image that has arrived since the last call, or None."""
        got = None
        if self._reading is not None:
            if not self._reading.done():
                return None
            got = self._reading.result()
        self._reading = self._methods.begin("image")
        if got is None:
            return None
        image = _plain_image(got, self._name)
        if image.time == self._last:
            return None
        self._last = image.time
        if self._apart:
            age = self._methods.clock() - image.time
            image = image._replace(time=now - age)
        fault = image_fault(image, now)
        if self._needs_mount and image.mount is None:
            fault = fault or "mount is missing: where is the camera?"
        if fault != self._fault and fault:
            log.warning("%s: %s", self._name, fault)
        self._fault = fault
        if fault:
            return None
        self._newest = self._methods.clock()
        return image

    @property
    def hindrance(self) -> str:
        """Reason to stand: no valid image for a while; empty otherwise."""
        since = self._began if self._newest is None else self._newest
        silent = self._methods.clock() - since
        if self._newest is not None and silent < IMAGE_SILENCE:
            return ""
        if self._fault:
            return f"image(): {self._fault}"
        if self._methods.blocked is not None:
            return f"image() has not returned for {silent:.1f} s"
        return f"image() returned no new image for {silent:.1f} s"

    def close(self) -> None:
        """Release a camera apart; a robot is closed by its driver."""
        if self._apart:
            self._methods.begin("close")
        self._methods.end()


def _plain_image(got: Any, name: str) -> CameraImage:
    """Return the result of image() as plain numbers."""
    try:
        time, pixels, focal_x, focal_y, mount = got
        if mount is not None:
            mount = CameraMount(*(float(value) for value in mount))
        pixels = np.ascontiguousarray(pixels)
        return CameraImage(
            float(time), pixels, float(focal_x), float(focal_y), mount
        )
    except FAILURES as error:
        raise SessionLost(
            f"{name} must return a CameraImage(time, pixels, focal_x, "
            f"focal_y, mount) or None, got {shown(got)}"
        ) from error


def image_fault(image: CameraImage, now: float) -> str:
    """Return why an image is invalid; empty if it is valid."""
    pixels, (low, high), mount = image.pixels, SIZES, image.mount
    shape, kind, age = pixels.shape, pixels.dtype, now - image.time
    if len(shape) != 3 or shape[2] != 3 or kind != np.uint8:
        return (
            "pixels must be red, green and blue as uint8, of shape (height, "
            f"width, 3), got {kind} of shape {shape}"
        )
    if not (low <= min(shape[:2]) and max(shape[:2]) <= high):
        return f"pixels must be {low} to {high} a side, got shape {shape}"
    for name in ("focal_x", "focal_y"):
        value = getattr(image, name)
        if not 0.1 * shape[1] < value < 20.0 * shape[1]:
            return (
                f"{name} must be in pixels of this image, {shape[1]} wide, "
                f"got {value:g}"
            )
    if not isfinite(image.time):
        return f"time must be finite, got {image.time}"
    if not -LEAD <= age <= OLDEST:
        return (
            f"an image is {age:.2f} s old by the clock of listen(); it must "
            f"be {OLDEST:g} s at most"
        )
    if mount is None:
        return ""
    if not all(isfinite(value) for value in mount):
        return f"mount must be finite, got {tuple(mount)}"
    if not 0.0 < mount.up < HIGHEST or max(map(abs, mount[:2])) > HIGHEST:
        return (
            f"the camera must be 0 to {HIGHEST:g} m high, got "
            f"{tuple(mount[:3])}: is the mount in millimetres?"
        )
    if max(map(abs, mount[3:])) > 2.0 * pi:
        return f"mount has angles {tuple(mount[3:])} rad: are they degrees?"
    return ""


def colour_image(image: CameraImage) -> ColourImage:
    """Return an image for perception."""
    height, width = image.pixels.shape[:2]
    model = CameraModel(width, height, image.focal_x, image.focal_y)
    return ColourImage(image.time, model, image.pixels)


class VideoCamera:
    """Camera of this computer by Video4Linux, through OpenCV.

    The device's buffer is set to one image, so that images are current. The
    exposure is assumed a constant latency before the arrival.
    """

    def __init__(
        self, path: str, model: CameraModel, *, latency: float
    ) -> None:
        """Open the camera."""
        import cv2

        is_device = path.startswith(DEVICE)
        if not Path(path).exists():
            raise SessionLost(f"no camera at {path}")
        backend = cv2.CAP_V4L2 if is_device else cv2.CAP_ANY
        self._device = cv2.VideoCapture(path, backend)
        if not self._device.isOpened():
            self._device.release()
            raise SessionLost(f"{path} cannot be opened as a camera")
        if is_device:
            self._device.set(cv2.CAP_PROP_FRAME_WIDTH, model.width)
            self._device.set(cv2.CAP_PROP_FRAME_HEIGHT, model.height)
            self._device.set(cv2.CAP_PROP_BUFFERSIZE, 1)
        self._model, self._latency = model, latency

    def image(self) -> CameraImage | None:
        """Wait for the next image; None at the end of a file."""
        import cv2

        is_read, image = self._device.read()
        if not is_read:
            sleep(PATIENCE)
            return None
        pixels = np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2RGB), np.uint8)
        now, model = monotonic() - self._latency, self._model
        down, across = np.divide(pixels.shape[:2], (model.height, model.width))
        focal = float(model.focal_x * across), float(model.focal_y * down)
        return CameraImage(now, pixels, *focal)

    def close(self) -> None:
        """Release the device."""
        self._device.release()


class PosedSight:
    """Sightings of the opponent by a camera, which the head may turn."""

    def __init__(
        self,
        session: "RobotSession",
        camera: RobotCamera,
        perception: "Perception",
        *,
        turns_head: bool,
    ) -> None:
        """Begin without an image."""
        self._session, self._camera = session, camera
        self._perception, self._turns_head = perception, turns_head
        self._mount: CameraMount | None = None  # at the newest image
        self._looking: Future[Any] | None = None
        self._last: RobotState | None = None
        self._poses: History[Pose] = History(MEMORY)

    def see(self, report: RobotState) -> RobotState:
        """Return a report with the newest sighting."""
        if report.hindrance:
            return report
        if self._last is not None and report.time == self._last.time:
            return report._replace(sighting=self._last.sighting)
        self._poses.note(report.time, report.pose)
        percepts = []
        image = self._camera.take(report.time)
        if image is not None:
            assert image.mount is not None  # as the camera has checked
            self._mount = image.mount
            pose = self._poses.at(image.time, _between)
            self._perception.note_pose(
                pose_of_camera(image.time, pose, image.mount)
            )
            percepts.append(colour_image(image))
        sighting = None
        if self._mount is not None:
            now = pose_of_camera(report.time, report.pose, self._mount)
            sighting = self._perception.see_from(now, percepts)
            if self._turns_head:
                self._look()
        self._last = report._replace(
            sighting=sighting, hindrance=self._camera.hindrance
        )
        return self._last

    def close(self) -> None:
        """Close the camera."""
        self._camera.close()

    def _look(self) -> None:
        """Turn the head, unless the last call has not returned."""
        if self._looking is not None:
            if not self._looking.done():
                return
            self._looking.result()
        head, robot = self._perception.head, self._session.robot
        yaw, pitch = head.yaw, head.pitch
        self._looking = self._session.tell(
            "look", lambda: robot.look(yaw, pitch)
        )


def _between(one: Pose, other: Pose, share: float) -> Pose:
    """Return the pose at a share of the way from one pose to another."""
    x, y, _ = (1.0 - share) * np.array(one) + share * np.array(other)
    turn = wrap_angle(other.theta - one.theta)
    return Pose(float(x), float(y), one.theta + share * turn)


def pose_of_camera(time: float, robot: Pose, mount: CameraMount) -> BodyPose:
    """Return the body of a robot of which only the camera matters."""
    turn = rotation(0.0, 0.0, robot.theta)
    floor = np.array([robot.x, robot.y, 0.0])
    return BodyPose(
        time,
        robot,
        floor,
        turn,
        floor + turn @ mount[:3],
        turn @ rotation(mount.roll, mount.pitch, mount.yaw),
        mount.yaw,
        mount.pitch,
    )
