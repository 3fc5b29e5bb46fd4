"""Value types of a robot description."""

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
    """Names of a robot's sensors in its model.

    Attributes:
        gyro: Gyroscope, in the axes of the torso.
        accelerometer: Accelerometer, in the axes of the torso.
        feet: Touch sensors, and their sites of the same names: four under
            the left foot, then four under the right one, each in the order
            front left, front right, rear left, rear right.
    """

    gyro: str = "gyro"
    accelerometer: str = "accelerometer"
    feet: tuple[str, ...] = FOOT_FORCES


@dataclass(frozen=True, slots=True)
class ReferencePoint:
    """Reference point of the torso, and reach of the body around it.

    Attributes:
        forward: Sagittal coordinate of the reference point in the torso
            frame, in [m]: the point midway between the hips.
        reach: Radius around the reference point that contains the whole
            standing robot with arms stretched, in [m]. Robots farther apart
            than the sum of their reaches cannot touch.
    """

    forward: float = 0.0
    reach: float = 1.0


class ServoGains(NamedTuple):
    """Position servo of one joint.

    Attributes:
        stiffness: Proportional gain, in [N m/rad].
        damping: Derivative gain, in [N m s/rad], which includes the damping
            of the joint.
        torque: Torque limit, in [N m].
        armature: Reflected rotor inertia, in [kg m^2]; 0 to keep that of
            the model.
    """

    stiffness: float
    damping: float
    torque: float
    armature: float = 0.0


class SoleFrame(NamedTuple):
    """Foot frame at the sole, under the ankle.

    Attributes:
        body: Body of the foot.
        place: Origin in the frame of that body, in [m].
        turn: Orientation in the frame of that body, as a quaternion
            (w, x, y, z).
    """

    body: str
    place: tuple[float, float, float]
    turn: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Overlay:
    """Elements that are added to a published model when it is read.

    Attributes:
        soles: Left and right foot frame; empty for no overlay.
        servos: Servo of each actuated joint.
        meshes: Additional folders in which mesh files are looked up by
            name.
        turn: Orientation of the published torso in axes (forward, left,
            up), as a quaternion (w, x, y, z), for a model whose torso has
            other axes.
    """

    soles: tuple[SoleFrame, ...] = ()
    servos: Mapping[str, ServoGains] = field(default_factory=dict)
    meshes: tuple[str, ...] = ()
    turn: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)


NO_OVERLAY = Overlay()
