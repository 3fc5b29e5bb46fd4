"""A NAO V6 on LoLA, by msgpack and sockets alone.

Keys, lengths and signs are those of NAO V6's protocol: 25 motors, frames of
896 bytes every 12 ms, an accelerometer that reads minus the specific force,
foot sensors in [kg].
"""

import socket
from pathlib import Path
from threading import Thread
from typing import Any

import pytest

from flows.running import LONGEST

msgpack = pytest.importorskip("msgpack")

JOINTS = (
    "HeadYaw HeadPitch LShoulderPitch LShoulderRoll LElbowYaw LElbowRoll "
    "LWristYaw LHipYawPitch LHipRoll LHipPitch LKneePitch LAnklePitch "
    "LAnkleRoll RHipRoll RHipPitch RKneePitch RAnklePitch RAnkleRoll "
    "RShoulderPitch RShoulderRoll RElbowYaw RElbowRoll RWristYaw LHand RHand"
).split()
TICK = 0.012  # [s]
FRAME = 896  # [bytes]
# A simulated robot whose time may pause, by its serial number.
PAUSES = "stepaside-lockstep-0"
WEIGHT = 5.3  # [kg], on eight foot sensors


def frame_of(number: int, position: list[float], **changes: Any) -> bytes:
    """Return the frame of a robot that stands without a fault."""
    values = {
        "Position": position,
        "Stiffness": [1.0] * 25,
        "Current": [0.0] * 25,
        "Temperature": [30.0] * 25,
        "Status": [0] * 25,
        "Accelerometer": [0.0, 0.0, -9.81 + 0.02 * (number % 7)],
        "Gyroscope": [0.0] * 3,
        "Angles": [0.0] * 2,
        "FSR": [WEIGHT / 8] * 8,
        "Sonar": [2.55] * 2,
        "Touch": [0.0] * 14,
        "Battery": [1.0, 0.0, 0.0, float(number)],
        "RobotConfig": [PAUSES, "6.0.0"] * 2,
    } | changes
    return bytes(msgpack.packb(values, use_single_float=True))


def listening(path: Path) -> socket.socket:
    made = socket.socket(socket.AF_UNIX)
    made.bind(str(path))
    made.listen(1)
    made.settimeout(LONGEST)
    return made


# Our robot on LoLA, with a detector that sees the opponent at one place.
SEEING = """
import stepaside as sa
from stepaside.drivers.lola import LolaRobot

class Seeing(LolaRobot):
    def __init__(self):
        super().__init__({path!r})

    def listen(self):
        state = super().listen()
        if state is None:
            return None
        sighting = sa.Sighting(state.time, {bearing}, {distance})
        return state._replace(sighting=sighting)
"""


class LolaRobot:
    """A NAO whose joints are where they are told to be.

    It presses its own chest button once it holds still. ``client`` is the
    address for ``play`` of a robot that sees its opponent at one place.
    """

    def __init__(self, path: Path, bearing: float, distance: float) -> None:
        file = path.with_name("seeing.py")
        text = SEEING.format(
            path=str(path), bearing=bearing, distance=distance
        )
        file.write_text(text, encoding="utf-8")
        self.client = f"{file}:Seeing"
        self._socket = listening(path)
        self.position = [0.0] * 25
        self.moved = 0.0  # way of its legs since its button was pressed
        self.number = 0
        self.faults: dict[str, Any] = {}  # of its frames
        self._pressed = 0
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        with self._socket:
            link, _ = self._socket.accept()
            with link:
                try:
                    self._serve(link)
                except OSError:  # the client has gone
                    pass

    def _serve(self, link: socket.socket) -> None:
        link.settimeout(LONGEST)
        answers, still = msgpack.Unpacker(), 0
        while True:
            press = 300 <= still < 310 and not self._pressed
            touch = [float(press)] + [0.0] * 13
            link.sendall(
                frame_of(
                    self.number,
                    self.position,
                    **({"Touch": touch} | self.faults),
                )
            )
            while (answer := next(answers, None)) is None:
                data = link.recv(4096)
                if not data:
                    return
                answers.feed(data)
            targets = answer.get("Position", self.position)
            way = sum(
                abs(a - b)
                for a, b in zip(
                    targets[7:18], self.position[7:18], strict=True
                )
            )
            stiff = min(answer.get("Stiffness", [0.0])[:1]) > 0.9
            still = still + 1 if way < 1e-6 and stiff else 0
            if still == 310:
                self._pressed = self.number
            self.moved += way if self._pressed else 0.0
            self.position = list(targets)
            self.number += 1
