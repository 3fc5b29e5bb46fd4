"""NAO V6 over LoLA: joint targets every 12 ms.

Frames are MessagePack maps. Published facts and their sources are in
docs/nao.md.
"""

import select
import socket
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from time import sleep
from typing import Any

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..perception.measurement import RobotState, RobotStatus
from .robot import JointRobot, JointTargets
from .robot_loader import RobotRequest
from .safety import SafetyState

try:
    import msgpack
except ImportError as error:
    raise ConfigurationError(
        "LoLA needs msgpack: pip install 'stepaside[robot]'"
    ) from error

PATH = "/tmp/robocup"  # socket of every NAO V6
LOCK_STEP = "stepaside-lockstep-0"  # serial number of a robot that waits
FRAME = 896  # of a sensor frame, in bytes
TICK = 0.012  # [s]
LOW = 0.05  # stiffness from which a robot goes limp at once
JOINTS = tuple(
    (
        "HeadYaw HeadPitch LShoulderPitch LShoulderRoll LElbowYaw LElbowRoll "
        "LWristYaw LHipYawPitch LHipRoll LHipPitch LKneePitch LAnklePitch "
        "LAnkleRoll RHipRoll RHipPitch RKneePitch RAnklePitch RAnkleRoll "
        "RShoulderPitch RShoulderRoll RElbowYaw RElbowRoll RWristYaw LHand "
        "RHand"
    ).split()
)
# Legs folded over the feet: the robot does not fall when it goes limp.
CROUCH = {
    **{"HipYawPitch": 0.0, "HipRoll": 0.0, "HipPitch": -0.92},
    **{"KneePitch": 2.1, "AnklePitch": -1.18, "AnkleRoll": 0.0},
}
# Stall torque [N m] times no-load speed [rad/s] by the end of a joint's name;
# over the voltage they give the stall current of a direct current motor. The
# battery has 25.2 V when it is full; that the data sheet's speeds are those
# at its 21.6 V is an assumption. Nothing is published about the hands.
POWER = {
    **{"Yaw": 2.149 * 7.457, "HeadPitch": 2.477 * 6.469},
    **{"ElbowRoll": 2.477 * 6.469, "ShoulderRoll": 2.477 * 6.469},
    **{"ShoulderPitch": 3.366 * 7.944, "WristYaw": 0.476 * 17.381},
    **{"HipYawPitch": 13.085 * 4.526, "HipRoll": 13.085 * 4.526},
    **{"AnkleRoll": 13.085 * 4.526, "HipPitch": 8.505 * 6.963},
    **{"KneePitch": 8.505 * 6.963, "AnklePitch": 8.505 * 6.963},
    "Hand": np.inf,
}
STALL_CURRENT = np.array(
    [
        POWER[max((end for end in POWER if name.endswith(end)), key=len)]
        for name in JOINTS
    ]
) * (25.2 / 21.6**2)  # in [A]
CHEST, BUMPERS = 0, (4, 5, 9, 10)  # in Touch
GRAVITY = 9.81  # foot sensors read in kilograms
CHEST_COLOURS = {
    SafetyState.LIMP: (1.0, 0.0, 0.0),
    SafetyState.REACHING: (1.0, 0.5, 0.0),
    SafetyState.READY: (0.0, 1.0, 0.0),
    SafetyState.WALKING: (0.0, 0.0, 1.0),
    SafetyState.STOPPING: (0.5, 0.0, 1.0),
    SafetyState.RESTING: (1.0, 1.0, 0.0),
}


class LolaRobot(JointRobot):
    """NAO V6: stiffness is a share, from 0 to 1."""

    tick, joints = TICK, JOINTS
    gains = dict.fromkeys(JOINTS, (1.0, 0.0))
    stands, shares_connection, takes_gains = False, True, False
    stamped = False  # frames carry no time, and are counted
    crouch = {name: CROUCH[name[1:]] for name in JOINTS if name[1:] in CROUCH}

    def __init__(self, path: str = PATH) -> None:
        """Make a robot at the path of its socket."""
        self._path = path
        self._lights: dict[str, list[float]] = {}

    def open(self) -> None:
        """Connect."""
        self._socket = socket.socket(socket.AF_UNIX)
        try:
            self._socket.connect(self._path)
        except OSError as error:
            self._socket.close()
            raise ConnectionError(
                f"no robot listens at {self._path}: {error}"
            ) from error
        self._buffer = bytearray()
        self._count, self._answered = -1, True
        self._last: tuple[float, Array] | None = None  # time and angles
        self._stiffness: list[float] | None = None  # that was commanded
        self._early = self._newest(5.0)
        serial = (self._early or {}).get("RobotConfig", [""])[0]
        self.paced = serial != LOCK_STEP

    def listen(self) -> RobotState | None:
        """Return the newest frame; None if it is damaged."""
        if not self._answered:
            self._send({})  # a silent client would stop some worlds
        patience = 0.0 if self._early else TICK
        frame = self._newest(patience) or self._early
        self._early = None
        if frame is None:
            return None
        self._answered = False
        try:
            return self._report(frame)
        except (KeyError, IndexError, TypeError, ValueError):
            return None

    def _report(self, frame: dict[str, Any]) -> RobotState:
        """Convert a frame; LoLA's accelerometer reads minus the force."""
        now, angles = self._count * TICK, np.array(frame["Position"])
        then, old = self._last or (now - TICK, angles)
        self._last = now, angles
        touch = frame["Touch"]
        roll, pitch = frame["Angles"]
        return RobotState(
            now,
            angles,
            np.array(frame["Gyroscope"]),
            -np.array(frame["Accelerometer"]),
            GRAVITY * np.array(frame["FSR"]),
            joint_velocities=(angles - old) / (now - then),
            tilt=(roll, pitch),
            status=RobotStatus(
                np.array(frame["Stiffness"]),
                np.array(frame["Temperature"]),
                np.array(frame["Status"]),
                np.array(frame["Current"]) / STALL_CURRENT,
                frame["Battery"][0],
                touch[CHEST] > 0.5,
                any(touch[at] > 0.5 for at in BUMPERS),
            ),
        )

    def command(self, targets: JointTargets) -> None:
        """Command all motors."""
        self._stiffness = targets.stiffness.tolist()
        self._send(
            {
                "Position": targets.angles.tolist(),
                "Stiffness": self._stiffness,
            }
        )

    def release(self) -> None:
        """Ramp the stiffness down within 0.5 s, unless it is low already."""
        frame = self._newest(0.0) or self._newest(4 * TICK) or {}
        none = [0.0] * len(JOINTS)
        angles = frame.get("Position", none)
        # The guardian commanded nothing: it knows what the robot reports.
        stiffness = self._stiffness or frame.get("Stiffness", none)
        count = round(0.5 / TICK) if max(stiffness) > LOW else 1
        for left in range(count - 1, -1, -1):
            shares = [left / count * share for share in stiffness]
            with suppress(BlockingIOError):
                self._send({"Position": angles, "Stiffness": shares})
            if left:
                self._newest(TICK)
        if count > 1:
            sleep(2 * TICK)  # until the robot has read it
        self._stiffness = none

    def show(self, state: SafetyState, *, sees: bool) -> None:
        """Show the state by the chest, and a sighting by the eyes."""
        self._lights = {
            "Chest": list(CHEST_COLOURS[state]),
            "LEye": [float(sees)] * 24,
            "REye": [float(sees)] * 24,
            "Skull": [float(state.moves_by_control)] * 12,
        }

    def close(self) -> None:
        """Disconnect."""
        self._socket.close()

    def _newest(self, patience: float) -> dict[str, Any] | None:
        """Return the newest frame that has arrived, if it is undamaged."""
        while len(self._buffer) < FRAME:
            if not select.select([self._socket], [], [], patience)[0]:
                return None
            part = self._socket.recv(1 << 16)
            if not part:
                raise ConnectionError("the robot closed the connection")
            self._buffer += part
        count = len(self._buffer) // FRAME
        data = bytes(self._buffer[(count - 1) * FRAME : count * FRAME])
        del self._buffer[: count * FRAME]
        self._count += count
        try:
            frame = msgpack.unpackb(data)
        except (ValueError, msgpack.exceptions.UnpackException):
            return None
        return frame if isinstance(frame, dict) else None

    def _send(self, values: dict[str, Any]) -> None:
        self._answered = True
        data = msgpack.packb(self._lights | values, use_single_float=True)
        if self._socket.send(data, socket.MSG_DONTWAIT) < len(data):
            raise ConnectionError("the robot does not read")


def make_robot(request: RobotRequest) -> Callable[[], LolaRobot]:
    """Return a function that makes the robot at ``lola:PATH``."""
    return partial(LolaRobot, request.address or PATH)
