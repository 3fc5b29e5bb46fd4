"""What a description says of a robot beside its links: small values."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

FOOT_FORCES = tuple(
    f"{side}_fsr_{place}"
    for side in "lr"
    for place in ("front_left", "front_right", "rear_left", "rear_right")
)


@dataclass(frozen=True, slots=True)
class SensorNames:
    """Sensors of a robot, by the names that its model has for them.

    Attributes:
        gyro: Gyroscope of the torso, whose axes are those of its body.
        accelerometer: Accelerometer, likewise.
        feet: Touch sensors and, of the same names, their sites: four under
            the left foot, then four under the right one, each as front left,
            front right, rear left, rear right.
    """

    gyro: str = "gyro"
    accelerometer: str = "accelerometer"
    feet: tuple[str, ...] = FOOT_FORCES


@dataclass(frozen=True, slots=True)
class ReferencePoint:
    """Where a robot is, and how far it reaches.

    Attributes:
        forward: How far the point of the torso that is midway between the
            hips lies ahead of the torso's origin, in [m].
        reach: Distance within which any of it lies around that point when
            it stands, arms stretched, in [m]: robots that are farther apart
            than both reaches do not touch.
    """

    forward: float = 0.0
    reach: float = 1.0


class ServoGains(NamedTuple):
    """Servo of one joint.

    Attributes:
        stiffness: Torque by angle, in [N m/rad].
        damping: Torque by speed, in [N m s/rad]; it stands for that of the
            joint, too.
        torque: Greatest torque, in [N m].
        armature: Inertia of the rotor at the joint, in [kg m^2]; that of
            the model if it is 0.
    """

    stiffness: float
    damping: float
    torque: float
    armature: float = 0.0


class SoleFrame(NamedTuple):
    """Where a foot frame is: at the sole, under the ankle.

    Attributes:
        body: Body of the foot.
        place: Origin in that body's frame, in [m].
        turn: Quaternion (w, x, y, z) of the foot frame in it.
    """

    body: str
    place: tuple[float, float, float]
    turn: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Overlay:
    """What is put on a published model when it is read.

    Attributes:
        soles: Left and right foot frame; empty for no overlay.
        servos: Servo of each joint that has one.
        meshes: Folders in which mesh files are looked for by name, beside
            where the model says.
        turn: Quaternion (w, x, y, z) of the published torso's axes in
            (forward, left, up), for a model whose torso looks elsewhere.
    """

    soles: tuple[SoleFrame, ...] = ()
    servos: Mapping[str, ServoGains] = field(default_factory=dict)
    meshes: tuple[str, ...] = ()
    turn: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)


NO_OVERLAY = Overlay()
