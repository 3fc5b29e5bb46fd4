"""Unitree G1 in its walking mode, for ``stepaside play``.

Needs ``unitree_sdk2py``, which pins CycloneDDS 0.10: install it in an
environment of its own, without the extra ``robot``. For an H1 replace ``g1``
by ``h1``. Not tested on a robot.
"""

import os
from typing import Any

import stepaside as sa

INTERFACE = os.environ.get("UNITREE_INTERFACE", "eth0")
STATE = "rt/odommodestate"
HOLD = 0.6  # time for which the robot keeps a velocity, in [s]
TIMEOUT = 0.5  # of a call, in [s]


class UnitreeRobot(sa.VelocityRobot):
    """Robot that walks by ``LocoClient.SetVelocity``, which times out."""

    limits = sa.VelocityLimits(forward=0.5, backward=0.3, turn=0.8)
    keeps_walking = False
    newest: sa.RobotState | None = None

    def open(self) -> None:
        """Connect, without moving the robot."""
        from unitree_sdk2py.core.channel import (
            ChannelFactoryInitialize,
            ChannelSubscriber,
        )
        from unitree_sdk2py.g1.loco.g1_loco_client import LocoClient
        from unitree_sdk2py.idl.unitree_go.msg.dds_ import SportModeState_

        ChannelFactoryInitialize(0, INTERFACE)
        self.client = LocoClient()
        self.client.SetTimeout(TIMEOUT)
        self.client.Init()
        self.states = ChannelSubscriber(STATE, SportModeState_)
        self.states.Init(self.note, 1)

    def note(self, state: Any) -> None:
        """Store a message; called by the SDK."""
        time = state.stamp.sec + 1e-9 * state.stamp.nanosec
        yaw = state.imu_state.rpy[2]
        pose = sa.Pose(state.position[0], state.position[1], yaw)
        self.newest = sa.RobotState(time, pose=pose)

    def prepare(self) -> None:
        """Take velocities; the robot stands already."""
        self.client.Start()

    def listen(self) -> sa.RobotState | None:
        """Return the newest pose; add a sighting of your own detector."""
        return self.newest

    def command(self, forward: float, lateral: float, turn: float) -> None:
        """Walk at a velocity, in [m/s] and [rad/s], for a short time."""
        code = self.client.SetVelocity(forward, lateral, turn, HOLD)
        if code != 0:
            raise ConnectionError(f"SetVelocity returned {code}")

    def close(self) -> None:
        """Unsubscribe."""
        self.states.Close()
