"""Perception of a robot that walks by itself and tells where it is."""

from bisect import insort

from ..core.poses import Array, Pose
from .measurement import Measurement, Sighting
from .perception import Perception


class PlanarPerception(Perception):
    """Sees from a body that stays level, midway between its feet."""

    def see_level(
        self, measurement: Measurement, frame: Pose
    ) -> Sighting | None:
        """Take in what a robot gives that walks by itself, and stays level.

        Args:
            measurement: What its sensors give.
            frame: Of the robot in its odometry.

        Returns:
            Where the other is now, as far as is known.
        """
        joints = measurement.joint_positions
        body = self._kinematics.level(measurement.time, joints, frame)
        return self._see(measurement, body)

    def recall_level(self, time: float, joints: Array, frame: Pose) -> None:
        """Remember where such a robot was between two of its reports.

        Args:
            time: The instant, in [s].
            joints: Angles then, in [rad]. Shape (joints,).
            frame: Of the robot in its odometry then.
        """
        if len(self._poses) == self._poses.maxlen:
            self._poses.popleft()
        body = self._kinematics.level(time, joints, frame)
        insort(self._poses, body, key=lambda pose: pose.time)
