"""Camera of a robot that a user connects in Python."""

import logging
from collections.abc import Callable
from concurrent.futures import Future
from math import isfinite, pi
from time import monotonic
from typing import Any, NamedTuple, Protocol

import numpy as np

from ..core.errors import ConfigurationError, shown
from ..core.user_file import FAILURES
from ..perception.camera_model import CameraModel
from ..perception.images import ColourImage, Percept, Pixels
from .guardian_process import SessionLost
from .image_source import ImageSource
from .method_thread import MethodThread

SIZES = 8, 4096  # of an image, in [px]
OLDEST = 0.5  # age of an image that is not used, in [s]
LEAD = 0.1  # by which its time may be ahead of the reports', in [s]
SILENCE = 0.5  # without an image before the robot must stand, in [s]
HIGHEST = 4.0  # plausible height of a camera, in [m]
log = logging.getLogger(__name__)


class CameraMount(NamedTuple):
    """Pose of a camera from the robot's reference point on the floor.

    Attributes:
        forward: Position ahead, in [m].
        left: Position to the left, in [m].
        up: Height above the floor, in [m].
        yaw: Direction of view from the heading, in [rad], positive leftward.
        pitch: Direction of view below the horizontal, in [rad].
        roll: Turn about the direction of view, in [rad].
    """

    forward: float
    left: float
    up: float
    yaw: float = 0.0
    pitch: float = 0.0
    roll: float = 0.0


class CameraImage(NamedTuple):
    """Image of a robot's camera, without distortion.

    Attributes:
        time: Middle of the exposure, by the clock of the reports, in [s].
        pixels: Red, green and blue, 0 to 255. Shape (height, width, 3).
        focal_x: Horizontal focal length at this size, in [px].
        focal_y: Vertical focal length at this size, in [px].
        mount: Pose of the camera at the exposure. A robot that is driven by
            its joints needs none: its description says where the camera is.
    """

    time: float
    pixels: Pixels
    focal_x: float
    focal_y: float
    mount: CameraMount | None = None


class HeadLimits(NamedTuple):
    """Range of a head that turns toward the opponent.

    Attributes:
        yaw: To each side, in [rad].
        up: Upward, in [rad].
        down: Downward, in [rad].
    """

    yaw: float
    up: float
    down: float


def check_head_limits(limits: Any, where: str) -> None:
    """Check the range of a head.

    Args:
        limits: What a class has as its ``head``.
        where: Name of the class, for messages.

    Raises:
        ConfigurationError: If it is invalid.
    """
    try:
        values = [float(value) for value in HeadLimits(*limits)]
        good = all(isfinite(v) and v > 0.0 for v in values)
    except FAILURES:
        good = False
    if not good or max(values) > pi:
        raise ConfigurationError(
            f"{where}: head must be HeadLimits(yaw, up, down), > 0, in [rad], "
            f"got {shown(limits)}"
        )


def image_fault(image: CameraImage) -> str:
    """Return why an image is invalid; empty if it is valid."""
    pixels, (low, high) = image.pixels, SIZES
    shape, kind = pixels.shape, pixels.dtype
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
    return "" if image.mount is None else _mount_fault(image.mount)


def _mount_fault(mount: CameraMount) -> str:
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


def converted_image(got: Any, name: str) -> CameraImage:
    """Return an image of plain numbers.

    Args:
        got: Result of image().
        name: Name of the method, for messages.

    Raises:
        SessionLost: If it is no image.
    """
    try:
        time, pixels, focal_x, focal_y, mount = got
        if mount is not None:
            mount = CameraMount(*(float(value) for value in mount))
        return CameraImage(
            float(time),
            np.ascontiguousarray(pixels),
            float(focal_x),
            float(focal_y),
            mount,
        )
    except FAILURES as error:
        raise SessionLost(
            f"{name} must return a CameraImage(time, pixels, focal_x, "
            f"focal_y, mount) or None, got {shown(got)}"
        ) from error


class PosedCamera(Protocol):
    """Camera whose images bring its pose on the robot."""

    @property
    def hindrance(self) -> str:
        """Reason to stand: no valid image for a while; empty otherwise."""

    def take(self, now: float) -> CameraImage | None:
        """Return an image that has arrived since the last call, or None.

        Args:
            now: Time of the newest report, in [s].
        """

    def close(self) -> None:
        """Release the camera."""


class MountedCamera:
    """Camera that is read apart from its robot, fixed on it."""

    def __init__(
        self,
        source: ImageSource,
        mount: CameraMount,
        *,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Begin without an image.

        Args:
            source: Source of the images; closed with this object.
            mount: Pose of the camera on the robot.
            clock: Time of this computer, in [s].
        """
        self._source, self._mount, self._clock = source, mount, clock
        self._newest = clock()

    @property
    def hindrance(self) -> str:
        """Reason to stand: no image for a while; empty otherwise."""
        silent = self._clock() - self._newest
        return f"no image for {silent:.1f} s" if silent > SILENCE else ""

    def take(self, now: float) -> CameraImage | None:
        """Return the newest image, if there is a new one."""
        image = None
        for found in self._source.percepts(now):
            if isinstance(found, ColourImage):
                image = found
        if image is None:
            return None
        self._newest = self._clock()
        model = image.camera
        return CameraImage(
            *(image.time, image.pixels, model.focal_x, model.focal_y),
            self._mount,
        )

    def close(self) -> None:
        """Release the camera."""
        self._source.close()


class RobotCamera:
    """Images by the method image() of a user's robot.

    It is called in a thread of its own, as it may wait for an image.
    """

    def __init__(self, robot: Any, *, needs_mount: bool) -> None:
        """Begin without an image; the robot is connected.

        Args:
            robot: The robot.
            needs_mount: Whether the images must bring the camera's pose.
        """
        self._methods = MethodThread(robot)
        self._name = self._methods.name_of("image")
        self._needs_mount = needs_mount
        self._reading: Future[Any] | None = None
        self._last = float("nan")
        self._newest: float | None = None  # valid image, on our clock
        self._began = self._methods.clock()
        self._logged = ""

    def percepts(self, now: float) -> list[Percept]:
        """Return the newest image, if there is a new one; see :meth:`take`."""
        image = self.take(now)
        return [] if image is None else [colour_image(image, image.time)]

    def take(self, now: float) -> CameraImage | None:
        """Return an image that has arrived since the last call, or None.

        Args:
            now: Time of the newest report, in [s].

        Raises:
            SessionLost: If image() failed, or returned no image.
        """
        if self._reading is None:
            self._reading = self._methods.begin("image")
            return None
        if not self._reading.done():
            return None
        got = self._reading.result()
        self._reading = self._methods.begin("image")
        if got is None:
            return None
        image = converted_image(got, self._name)
        if image.time == self._last:
            return None
        self._last = image.time
        fault = image_fault(image) or self._fault_of_time(image, now)
        if self._needs_mount and image.mount is None:
            fault = fault or "mount is missing: where is the camera?"
        if fault != self._logged and fault:
            log.warning("%s: %s", self._name, fault)
        self._logged = fault
        if fault:
            return None
        self._newest = self._methods.clock()
        return image

    @property
    def hindrance(self) -> str:
        """Reason to stand: no valid image for a while; empty otherwise."""
        since = self._began if self._newest is None else self._newest
        silent = self._methods.clock() - since
        if self._newest is not None and silent < SILENCE:
            return ""
        if self._logged:
            return f"image(): {self._logged}"
        if self._methods.blocked is not None:
            return f"image() has not returned for {silent:.1f} s"
        return f"image() returned no new image for {silent:.1f} s"

    def close(self) -> None:
        """Do nothing: the robot is closed by its driver."""

    @staticmethod
    def _fault_of_time(image: CameraImage, now: float) -> str:
        age = now - image.time
        if -LEAD <= age <= OLDEST:
            return ""
        return (
            f"an image is {age:.2f} s old by the clock of listen(); it must "
            f"be {OLDEST:g} s at most"
        )


def colour_image(image: CameraImage, time: float) -> ColourImage:
    """Return an image for perception, at a time in [s]."""
    height, width = image.pixels.shape[:2]
    model = CameraModel(width, height, image.focal_x, image.focal_y)
    return ColourImage(time, model, image.pixels)
