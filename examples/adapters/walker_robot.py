"""Robot of ``walker_sdk``, for ``stepaside play``."""

import os

from walker_sdk import ADDRESS, WalkerClient

import stepaside as sa

PORT = int(os.environ.get("WALKER_PORT", ADDRESS[1]))


class WalkerRobot(sa.VelocityRobot):
    """Robot that walks by the SDK's ``Move(vx, vy, vyaw)``."""

    limits = sa.VelocityLimits(
        forward=0.5, backward=0.4, lateral=0.3, turn=1.0
    )

    def open(self) -> None:
        """Connect, without moving the robot."""
        self.client = WalkerClient((ADDRESS[0], PORT))
        self.client.Connect(timeout=1.0)

    def listen(self) -> sa.RobotState | None:
        """Return the newest state, with the nearest person."""
        state = self.client.ReadState(timeout=0.05)
        if state is None:
            return None
        sighting = None
        if state.person is not None:
            sighting = sa.Sighting.of_position(state.time, *state.person)
        pose = sa.Pose(state.x, state.y, state.yaw)
        return sa.RobotState(state.time, sighting=sighting, pose=pose)

    def command(self, forward: float, lateral: float, turn: float) -> None:
        """Walk at a velocity, in [m/s] and [rad/s]."""
        self.client.Move(forward, lateral, turn)

    def stop(self) -> None:
        """Stand."""
        self.client.StopMove()

    def close(self) -> None:
        """Disconnect."""
        self.client.Close()
