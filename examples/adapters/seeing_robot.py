"""Robot of ``walker_sdk`` that finds its opponent by its camera."""

import numpy as np
from walker_robot import WalkerRobot

import stepaside as sa


class SeeingRobot(WalkerRobot):
    """The same robot; its sightings come from images."""

    head = sa.HeadLimits(yaw=1.5, up=0.3, down=0.8)

    def listen(self) -> sa.RobotState | None:
        """Return the newest state, without a sighting."""
        report = super().listen()
        return None if report is None else report._replace(sighting=None)

    def image(self) -> sa.CameraImage | None:
        """Return the newest image, with the pose of the camera."""
        image = self.client.ReadImage(timeout=0.1)
        if image is None:
            return None
        shape = image.height, image.width, 3
        pixels = np.frombuffer(image.pixels, np.uint8).reshape(shape)
        yaw, pitch = image.head
        mount = sa.CameraMount(0.0, 0.0, image.up, yaw, pitch)
        return sa.CameraImage(
            image.time, pixels, image.focal, image.focal, mount
        )

    def look(self, yaw: float, pitch: float) -> None:
        """Turn the head toward the opponent."""
        self.client.MoveHead(yaw, pitch)
