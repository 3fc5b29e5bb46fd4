"""Perception of a robot that walks by itself and reports its pose."""

from bisect import insort

from ..core.poses import Array, Pose
from .measurement import Measurement, Sighting
from .perception import Perception


class PlanarPerception(Perception):
    """Perception on a body that stays level, midway between its feet."""

    def see_level(
        self, measurement: Measurement, frame: Pose
    ) -> Sighting | None:
        """Process a measurement of a level robot.

        Args:
            measurement: Values of its sensors.
            frame: Pose of the robot in odometry.

        Returns:
            Sighting of the opponent; None if it is lost.
        """
        joints = measurement.joint_positions
        body = self._kinematics.level(measurement.time, joints, frame)
        return self._process(measurement, body)

    def recall_level(self, time: float, joints: Array, frame: Pose) -> None:
        """Store a pose between two reports, for images taken then.

        Args:
            time: Time of the pose, in [s].
            joints: Joint angles, in [rad]. Shape (joints,).
            frame: Pose of the robot in odometry.
        """
        if len(self._poses) == self._poses.maxlen:
            self._poses.popleft()
        body = self._kinematics.level(time, joints, frame)
        insort(self._poses, body, key=lambda pose: pose.time)
