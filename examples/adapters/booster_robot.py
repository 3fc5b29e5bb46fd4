"""Booster T1 or K1 in its walking mode, for ``stepaside play``.

Needs ``pip install booster-robotics-sdk-python``. Not tested on a robot.
"""

import os
from time import monotonic, sleep
from typing import Any

import stepaside as sa

ADDRESS = os.environ.get("BOOSTER_ADDRESS", "127.0.0.1")
STANDING_UP = 3.0  # in [s]


class BoosterRobot(sa.VelocityRobot):
    """Robot that walks by ``B1LocoClient.Move``, with its odometer."""

    limits = sa.VelocityLimits(forward=0.5, backward=0.3, turn=0.8)
    newest: sa.RobotState | None = None

    def open(self) -> None:
        """Connect, without moving the robot."""
        import booster_robotics_sdk_python as booster

        self.modes = booster.RobotMode
        booster.ChannelFactory.Instance().Init(0, ADDRESS)
        self.client = booster.B1LocoClient()
        self.client.Init()
        if not self.client.WaitForService(2000):
            raise ConnectionError(f"no Booster answers at {ADDRESS}")
        self.odometer = booster.B1OdometerStateSubscriber(self.note)
        self.odometer.InitChannel()

    def note(self, odometer: Any) -> None:
        """Store a message, which has no stamp; called by the SDK."""
        pose = sa.Pose(odometer.x, odometer.y, odometer.theta)
        self.newest = sa.RobotState(monotonic(), pose=pose)

    def prepare(self) -> None:
        """Stand, then take velocities."""
        self.client.ChangeMode(self.modes.kPrepare)
        sleep(STANDING_UP)
        self.client.ChangeMode(self.modes.kWalking)

    def listen(self) -> sa.RobotState | None:
        """Return the newest pose; add a sighting of your own detector."""
        return self.newest

    def command(self, forward: float, lateral: float, turn: float) -> None:
        """Walk at a velocity, in [m/s] and [rad/s], until the next one."""
        self.client.Move(forward, lateral, turn)

    def close(self) -> None:
        """Unsubscribe."""
        self.odometer.CloseChannel()
