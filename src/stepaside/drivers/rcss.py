"""K1 or T1 in the RoboCup simulator rcssservermj, driven by its joints.

Messages are S-expressions after their length. The simulator sends one every
20 ms: joints, gyro, accelerometer and pose of the torso, and every second
time the other players in sight, as polar coordinates in the frame of the
camera. It answers to a command for each motor, and may wait for ``(syn)``.
Angles are in degrees.
"""

import re
import socket
from collections.abc import Callable, Mapping
from functools import partial
from math import cos, degrees, radians, sin
from typing import Any

import numpy as np

from ..core.errors import ConfigurationError, ModelError
from ..core.rotations import angles_of, rotation, rotation_of
from ..perception.measurement import RobotState, Sighting
from .robot import JointRobot, JointTargets
from .robot_loader import RobotRequest

_ADDRESS = re.compile(r"(?P<host>[^:/]*):(?P<port>\d{1,5})")
_TOKEN = re.compile(rb"[()]|[^\s()]+")
LONGEST = 1 << 20  # plausible length of a message, in bytes
HEAD, PITCH, GAZE = "AAHead_yaw", "Head_pitch", 0.9  # and its range, in [rad]
TIMEOUT = 30.0  # for a message, in [s]; the simulator may wait for others
STEP = 0.02  # from one message to the next, in [s]
TRUNCATED = 0.005  # half of the unit to which times are truncated, in [s]
LANDING = 2.0  # after the drop from 0.4 m with which a game begins, in [s]
START = (-2.0, 3.0)  # place in the own half, in [m]
ARM = ("Shoulder_Pitch", "Shoulder_Roll", "Elbow_Pitch", "Elbow_Yaw")
LEG = (
    *("Hip_Pitch", "Hip_Roll", "Hip_Yaw"),
    *("Knee_Pitch", "Ankle_Pitch", "Ankle_Roll"),
)
# Gains that hold a posture, by part: those of Booster's deployment of the T1,
# with ankles as stiff as the other joints of a leg, to land upright.
GAINS = {"he": (20.0, 0.2), "ae": (20.0, 0.5), "te": (200.0, 5.0),
         "le": (200.0, 5.0)}  # fmt: skip


def _motors(shoulder: str, *, waist: bool) -> dict[str, str]:
    """Return motors by joint; ``shoulder`` precedes the first in an arm."""
    motors = {HEAD: "he1", PITCH: "he2"}
    for side, letter in (("Left", "l"), ("Right", "r")):
        for number, name in enumerate(ARM, 1):
            first = shoulder if number == 1 else ""
            motors[f"{first}{side}_{name}"] = f"{letter}ae{number}"
        for number, name in enumerate(LEG, 1):
            motors[f"{side}_{name}"] = f"{letter}le{number}"
    if waist:
        motors["Waist"] = "te1"
    return motors


# Motors, and distance of the camera ahead of the torso in [m], by model.
MODELS = {
    "K1": (_motors("A", waist=False), 0.066),
    "T1": (_motors("", waist=True), 0.11),
}


class LeagueRobot(JointRobot):
    """Player 1 of a team; players of all other teams are opponents."""

    tick, keeps_targets, paced = STEP, False, False

    def __init__(
        self,
        address: tuple[str, int],
        model: str,
        team: str,
        standing: Mapping[str, float],
    ) -> None:
        """Make a robot that joins the game later."""
        self._address, self._model, self._team = address, model, team
        motors, self._camera = MODELS[model]
        self.joints, self._motors = tuple(motors), tuple(motors.values())
        self._standing = [standing.get(name, 0.0) for name in self.joints]
        self.gains = dict(zip(self.joints, self._own(), strict=True))
        self._unanswered = False
        self._sighting: Sighting | None = None

    def open(self) -> None:
        """Join the game, facing the other half of the field."""
        self._socket = socket.create_connection(self._address, TIMEOUT)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._stream = self._socket.makefile("rb")
        self._send(f"(init {self._model} {self._team} 1)")
        x, y = START
        try:
            self._receive()
        except ConnectionError as error:
            raise ConnectionError(
                "the simulator refuses the robot: are there two teams, or a "
                f"player 1 of the team {self._team}, already?"
            ) from error
        self._send(f"(beam {x:g} {y:g} 0)(syn)")
        lands = JointTargets(
            np.array(self._standing), *np.array(self._own()).T
        )
        for _ in range(round(LANDING / STEP)):
            self._receive()
            self.command(lands)

    def listen(self) -> RobotState:
        """Return the next message."""
        if self._unanswered:
            self._send("(syn)")
        entries = parse_expressions(self._receive())
        self._unanswered = True
        return self._report(entries)

    def command(self, targets: JointTargets) -> None:
        """Command all motors, the head toward the opponent; go on."""
        rows = np.column_stack([np.degrees(targets.angles), *targets[1:]])
        if self._sighting is not None:
            gaze = min(max(self._sighting.bearing, -GAZE), GAZE)
            rows[self.joints.index(HEAD), 0] = degrees(gaze)
        self._unanswered = False
        motors = (
            f"({motor} {angle:.4f} 0 {stiffness:.4f} {damping:.4f} 0)"
            for motor, (angle, stiffness, damping) in zip(
                self._motors, rows.tolist(), strict=True
            )
        )
        self._send("".join(motors) + "(syn)")

    def release(self) -> None:
        """Hold the last targets: nothing in a simulator is in danger."""

    def close(self) -> None:
        """Leave the game."""
        self._stream.close()
        self._socket.close()

    def _report(self, entries: list[Any]) -> RobotState:
        """Convert a message."""
        found: dict[str, Any] = {}
        motions: dict[str, list[float]] = {}
        try:
            for kind, *fields in entries:
                if kind == "HJ":  # of motor he1: q_hj1
                    named = {key: value for key, value, *_ in fields}
                    motor = named["n"].removeprefix("q_").replace("j", "e")
                    motion = float(named["ax"]), float(named["vx"])
                    motions[motor] = [radians(value) for value in motion]
                else:
                    found[kind] = fields
            now = float(found["time"][0][1])
            gyro = np.radians(np.array(found["GYR"][1][1:], dtype=float))
            force = np.array(found["ACC"][1][1:], dtype=float)
            w, x, y, z = (float(value) for value in found["quat"][1][1:])
            joints = np.array([motions[motor] for motor in self._motors])
        except (KeyError, IndexError, ValueError) as error:
            raise ConnectionError(
                "a message lacks time, GYR, ACC, quat or a joint: it has "
                f"{', '.join(found)} and {len(motions)} joints"
            ) from error
        now = STEP * round((now + TRUNCATED) / STEP)
        roll, pitch, _ = angles_of(rotation_of((w, x, y, z)))
        seen = nearest_opponent(found.get("See", []), self._team)
        if seen is not None:
            head, nod = (
                joints[self.joints.index(name), 0] for name in (HEAD, PITCH)
            )
            level = (
                rotation(roll, pitch, 0.0) @ rotation(0.0, nod, head) @ seen
            )
            ahead = float(level[0]) + self._camera
            self._sighting = Sighting.of_position(now, ahead, float(level[1]))
        return RobotState(
            now,
            joints[:, 0],
            gyro,
            force,
            sighting=self._sighting,
            joint_velocities=joints[:, 1],
            tilt=(roll, pitch),
        )

    def _own(self) -> list[tuple[float, float]]:
        return [GAINS[motor[-3:-1]] for motor in self._motors]

    def _send(self, text: str) -> None:
        data = text.encode()
        self._socket.sendall(len(data).to_bytes(4, "big") + data)

    def _receive(self) -> bytes:
        head = self._stream.read(4)
        length = int.from_bytes(head, "big")
        if length > LONGEST:
            raise ConnectionError(
                f"a message of {length} bytes: is this the port for agents?"
            )
        data = self._stream.read(length)
        if len(head) < 4 or len(data) < length:
            raise ConnectionError("the simulator closed the connection")
        return data


def parse_expressions(text: bytes) -> list[Any]:
    """Parse a sequence of S-expressions to nested lists of words."""
    stack: list[list[Any]] = [[]]
    for token in _TOKEN.findall(text):
        if token == b"(":
            stack.append([])
        elif token != b")":
            stack[-1].append(token.decode("utf-8", "replace"))
        elif len(stack) > 1:
            done = stack.pop()
            stack[-1].append(done)
        else:
            raise ConnectionError("a message has too many parentheses")
    if len(stack) > 1:
        raise ConnectionError("a message ends within an expression")
    return [each for each in stack[0] if isinstance(each, list) and each]


def nearest_opponent(detections: list[Any], team: str) -> Any:
    """Return the nearest opponent in the camera's frame [m], or None.

    Its head is used, else the mean of its other parts.
    """
    found = []
    for kind, *fields in detections:
        parts = {key: value for key, value, *_ in fields}
        if kind != "P" or parts.pop("team", team) == team:
            continue
        parts.pop("id", None)
        polar = {n: [float(v) for v in p[1:4]] for n, p in parts.items()}
        if polar:
            values = polar.get("head") or np.mean(list(polar.values()), axis=0)
            found.append(tuple(float(value) for value in values))
    if not found:
        return None
    distance, azimuth, elevation = min(found)
    azimuth, elevation = radians(azimuth), radians(elevation)
    level = distance * cos(elevation)
    return np.array(
        [level * cos(azimuth), level * sin(azimuth), distance * sin(elevation)]
    )


def make_robot(request: RobotRequest) -> Callable[[], LeagueRobot]:
    """Return a function that makes the robot at ``rcss:HOST:PORT``.

    An empty host is this computer; the model is that of the description.
    """
    found = _ADDRESS.fullmatch(request.address)
    if not found or not 0 < int(found["port"]) < 1 << 16:
        raise ConfigurationError(
            f"robot must be rcss:HOST:PORT with a port in [1, 65535], got "
            f"'rcss:{request.address}'"
        )
    address = found["host"] or "127.0.0.1", int(found["port"])
    description = request.description
    joints = set(description.speed_limits)
    for name, (motors, _) in MODELS.items():
        if joints == set(motors):
            standing = description.standing
            return partial(LeagueRobot, address, name, request.role, standing)
    raise ModelError(
        "the simulator has the robots K1 and T1, got a description with the "
        f"joints {', '.join(description.speed_limits)}; `stepaside robot "
        "init` describes the models in the package rcsssmj"
    )
