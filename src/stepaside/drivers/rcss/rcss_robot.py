"""Robot of the RoboCup simulator rcssservermj, driven by its joints.

The simulator sends a message every 20 ms: joints, gyro, accelerometer and
pose of the torso, and every second time the other players in sight, as polar
coordinates in the frame of the camera. It answers to a motor command for each
joint, and may wait for ``(syn)``. Angles are in degrees.
"""

import re
from collections.abc import Mapping
from math import asin, atan2, cos, degrees, hypot, radians, sin
from typing import Any, NamedTuple

import numpy as np

from ...core.errors import ConfigurationError, ModelError
from ...core.rotations import rotation
from ...perception.measurement import Sighting
from ..joint.joint_robot import JointReport, JointRobot, JointTarget
from .league_messages import Expression, MessageSocket, parse_expressions

SCHEME = "rcss:"
_ADDRESS = re.compile(r"rcss:(?P<host>[^:/]*):(?P<port>\d{1,5})")
LOCAL = "127.0.0.1"
HEAD, GAZE = "AAHead_yaw", 0.9  # joint and its range, in [rad]
TIMEOUT = 30.0  # for a message, in [s]; the simulator may wait for others
STEP = 0.02  # from one message to the next, in [s]
TRUNCATED = 0.005  # half of the unit to which times are truncated, in [s]
LANDING = 2.0  # after the drop from 0.4 m with which a game begins, in [s]
START = (2.0, 3.0)  # distance from the halfway line, and to its left, in [m]
ARM = ("Shoulder_Pitch", "Shoulder_Roll", "Elbow_Pitch", "Elbow_Yaw")
LEG = (
    *("Hip_Pitch", "Hip_Roll", "Hip_Yaw"),
    *("Knee_Pitch", "Ankle_Pitch", "Ankle_Roll"),
)
# Gains that hold a posture, by part: those of Booster's deployment of the T1,
# with ankles as stiff as the other joints of a leg, to land upright.
GAINS = {"he": (20.0, 0.2), "ae": (20.0, 0.5), "te": (200.0, 5.0),
         "le": (200.0, 5.0)}  # fmt: skip


class LeagueModel(NamedTuple):
    """Robot model of the simulator.

    Attributes:
        motors: Motor of each joint of the model.
        camera: Distance of the camera ahead of the torso, in [m].
    """

    motors: Mapping[str, str]
    camera: float


def _league_model(shoulder: str, waist: bool, camera: float) -> LeagueModel:
    """Return a model; ``shoulder`` precedes the names of the first joints."""
    motors = {HEAD: "he1", "Head_pitch": "he2"}
    for side, letter in (("Left", "l"), ("Right", "r")):
        for number, name in enumerate(ARM, 1):
            first = shoulder if number == 1 else ""
            motors[f"{first}{side}_{name}"] = f"{letter}ae{number}"
        for number, name in enumerate(LEG, 1):
            motors[f"{side}_{name}"] = f"{letter}le{number}"
    if waist:
        motors["Waist"] = "te1"
    return LeagueModel(motors, camera)


MODELS = {
    "K1": _league_model("A", waist=False, camera=0.066),
    "T1": _league_model("", waist=True, camera=0.11),
}


class LeagueAddress(NamedTuple):
    """Address of the simulator."""

    host: str
    port: int


def parse_rcss_address(text: str) -> LeagueAddress:
    """Parse ``rcss:HOST:PORT``; an empty host is this computer.

    Raises:
        ConfigurationError: If it is no such address.
    """
    found = _ADDRESS.fullmatch(text)
    if not found or not 0 < int(found["port"]) < 1 << 16:
        raise ConfigurationError(
            f"robot must be rcss:HOST:PORT with a port in [1, 65535], got "
            f"{text!r}"
        )
    return LeagueAddress(found["host"] or LOCAL, int(found["port"]))


def league_model_of(joints: Mapping[str, Any]) -> str:
    """Return the name of the simulator's model with the joints of a robot.

    Args:
        joints: Joints of the description.

    Raises:
        ModelError: If the simulator has no such robot.
    """
    for name, model in MODELS.items():
        if set(joints) == set(model.motors):
            return name
    raise ModelError(
        "the simulator has the robots K1 and T1, got a description with the "
        f"joints {', '.join(joints)}; `stepaside robot init` describes the "
        "models in the package rcsssmj"
    )


class LeagueRobot(JointRobot):
    """K1 or T1 in the simulator."""

    tick = STEP
    keeps_targets = False
    paced = False

    def __init__(
        self,
        address: LeagueAddress,
        model: str,
        team: str,
        standing: Mapping[str, float],
    ) -> None:
        """Make a robot that joins the game later.

        Args:
            address: Address of the simulator.
            model: Name of its model.
            team: Name of its team; all players of other teams are opponents.
            standing: Posture in which it lands, in [rad], by joint; other
                joints are at zero.
        """
        self._standing = standing
        self._address, self._model, self._team = address, model, team
        self._motors, self._camera = MODELS[model]
        # Sensors of joint he1 are named q_hj1, and so on.
        self._joints = {
            motor.replace("e", "j"): joint
            for joint, motor in self._motors.items()
        }
        self.gains: Mapping[str, tuple[float, float]] = {
            joint: GAINS[motor[-3:-1]] for joint, motor in self._motors.items()
        }
        self._unanswered = False
        self._sighting: Sighting | None = None

    def open(self) -> None:
        """Join the game, facing the other half of the field.

        Raises:
            OSError: If there is no simulator, or it refuses the robot.
        """
        self._socket = MessageSocket(*self._address, TIMEOUT)
        self._socket.send(f"(init {self._model} {self._team} 1)")
        x, y = START
        try:
            self._socket.receive()
        except ConnectionError as error:
            raise ConnectionError(
                "the simulator refuses the robot: are there two teams, or a "
                f"player 1 of the team {self._team}, already?"
            ) from error
        self._socket.send(f"(beam {-x:g} {y:g} 0)(syn)")
        targets = {
            joint: JointTarget(self._standing.get(joint, 0.0), *gains)
            for joint, gains in self.gains.items()
        }
        for _ in range(round(LANDING / STEP)):
            self._socket.receive()
            self.command(targets)

    def listen(self) -> JointReport:
        """Return the next message as a report."""
        if self._unanswered:
            self._socket.send("(syn)")
        entries = parse_expressions(self._socket.receive())
        self._unanswered = True
        return self._report(entries)

    def command(self, targets: Mapping[str, JointTarget]) -> None:
        """Command all motors, the head toward the opponent; go on."""
        if self._sighting is not None and HEAD in targets:
            gaze = min(max(self._sighting.bearing, -GAZE), GAZE)
            targets = {**targets, HEAD: targets[HEAD]._replace(angle=gaze)}
        motors = (
            f"({self._motors[joint]} {degrees(angle):.4f} 0 {stiffness:.4f} "
            f"{damping:.4f} 0)"
            for joint, (angle, stiffness, damping) in targets.items()
        )
        self._unanswered = False
        self._socket.send("".join(motors) + "(syn)")

    def release(self) -> None:
        """Hold the last targets: nothing in a simulator is in danger."""

    def close(self) -> None:
        """Leave the game."""
        self._socket.close()

    def _report(self, entries: list[Expression]) -> JointReport:
        """Convert a message.

        Raises:
            ConnectionError: If an entry is missing.
        """
        found: dict[str, Any] = {}
        angles: dict[str, float] = {}
        rates: dict[str, float] = {}
        for kind, *fields in entries:
            if kind == "HJ":
                named = {key: value for key, value, *_ in fields}
                joint = self._joints.get(named["n"].removeprefix("q_"), "")
                angles[joint] = radians(float(named["ax"]))
                rates[joint] = radians(float(named["vx"]))
            else:
                found[kind] = fields
        try:
            now = float(found["time"][0][1])
            gyro = [radians(float(v)) for v in found["GYR"][1][1:]]
            force = [float(v) for v in found["ACC"][1][1:]]
            tilt = tilt_of(*(float(v) for v in found["quat"][1][1:]))
        except (KeyError, IndexError, ValueError) as error:
            raise ConnectionError(
                f"a message lacks time, GYR, ACC or quat: it has "
                f"{', '.join(found)}"
            ) from error
        now = STEP * round((now + TRUNCATED) / STEP)
        if "See" in found:
            seen = nearest_opponent(found["See"], self._team)
            if seen is not None:
                x, y = self._place(seen, angles, tilt)
                self._sighting = Sighting.of_position(now, x, y)
        return JointReport(
            *(now, angles, rates, gyro, force, tilt),
            sighting=self._sighting,
        )

    def _place(
        self,
        seen: tuple[float, float, float],
        angles: Mapping[str, float],
        tilt: tuple[float, float],
    ) -> tuple[float, float]:
        """Return the place of a detection ahead and to the left, in [m].

        Args:
            seen: Distance [m], azimuth and elevation [rad] in the camera.
            angles: Joint angles, in [rad].
            tilt: Roll and pitch of the torso, in [rad].
        """
        distance, azimuth, elevation = seen
        in_camera = np.array(
            [
                distance * cos(elevation) * cos(azimuth),
                distance * cos(elevation) * sin(azimuth),
                distance * sin(elevation),
            ]
        )
        head = rotation(0.0, angles["Head_pitch"], angles[HEAD])
        level = rotation(*tilt, 0.0) @ head @ in_camera
        return float(level[0]) + self._camera, float(level[1])


def nearest_opponent(
    detections: list[Any], team: str
) -> tuple[float, float, float] | None:
    """Return the nearest player of another team; None without one.

    Its head is used, else the mean of its other parts.

    Args:
        detections: Entries of a message's vision.
        team: Own team.

    Returns:
        Distance, in [m], azimuth and elevation in the camera, in [rad].
    """
    found = []
    for kind, *fields in detections:
        if kind != "P":
            continue
        parts = {key: value for key, value, *_ in fields}
        if parts.pop("team", team) == team:
            continue
        parts.pop("id", None)
        polar = {
            name: [float(v) for v in value[1:4]]
            for name, value in parts.items()
        }
        if polar:
            values = polar.get("head") or np.mean(list(polar.values()), axis=0)
            distance, azimuth, elevation = (float(v) for v in values)
            found.append((distance, radians(azimuth), radians(elevation)))
    return min(found, default=None)


def tilt_of(w: float, x: float, y: float, z: float) -> tuple[float, float]:
    """Return roll and pitch of a quaternion, in [rad]."""
    size = hypot(w, x, y, z)
    w, x, y, z = w / size, x / size, y / size, z / size
    roll = atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    pitch = asin(min(1.0, max(-1.0, 2.0 * (w * y - z * x))))
    return roll, pitch
