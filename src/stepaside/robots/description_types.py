"""Value types of a robot description."""

from dataclasses import dataclass

from ..core.errors import ModelError
from ..core.ranges import Range, positive
from ..core.setting import REQUIRED, CheckedSettings, setting

FOOT_FORCES = tuple(
    f"{side}_fsr_{place}"
    for side in "lr"
    for place in ("front_left", "front_right", "rear_left", "rear_right")
)
Place = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]  # (w, x, y, z), of any length
MOST = 1e6  # far above every gain and torque of a robot


def _at_least_zero(unit: str) -> Range:
    return Range(0.0, MOST, unit, "not negative")


@dataclass(frozen=True, slots=True)
class SensorNames(CheckedSettings, error=ModelError, prefix="sensors."):
    """Names of a robot's sensors in its model."""

    gyro: str = setting("gyro", "Gyroscope, in the axes of the torso")
    accelerometer: str = setting(
        "accelerometer", "Accelerometer, in the axes of the torso"
    )
    feet: tuple[str, ...] = setting(
        FOOT_FORCES,
        "Touch sensors, and their sites of the same names: four under the "
        "left foot, then four under the right one, each in the order front "
        "left, front right, rear left, rear right",
        count=(8, 8),
    )


@dataclass(frozen=True, slots=True)
class ReferencePoint(CheckedSettings, error=ModelError, prefix="place."):
    """Reference point of the torso, and reach of the body around it."""

    forward: float = setting(
        0.0,
        "Sagittal coordinate of the point midway between the hips in the "
        "torso frame",
        Range(-10.0, 10.0, "m", "within the body"),
    )
    reach: float = setting(
        1.0,
        "Radius around the reference point that contains the whole standing "
        "robot with arms stretched",
        positive("m"),
    )


@dataclass(frozen=True, slots=True)
class RobotGames(CheckedSettings, error=ModelError, prefix="game."):
    """Distances of a robot's games, and its scales relative to NAO."""

    safety_radius: float = setting(
        0.8, "Safety radius of the robot as evader", positive("m")
    )
    start_least: float = setting(
        0.4, "Smallest distance at which it may begin", positive("m")
    )
    start_near: float = setting(
        0.6, "Smallest distance that is drawn", positive("m")
    )
    start_far: float = setting(
        1.5, "Greatest distance that is drawn", positive("m")
    )
    push_unit: float = setting(
        1.0, "Impulse like 1 N s on NAO", positive("N s")
    )
    force_unit: float = setting(
        1.0, "Force like 1 N on NAO, by weight", positive("N")
    )
    length_unit: float = setting(
        1.0, "Length like 1 m for NAO, by CoM height", positive("m")
    )


@dataclass(frozen=True, slots=True)
class ServoGains(CheckedSettings, error=ModelError):
    """Position servo of one joint."""

    stiffness: float = setting(
        REQUIRED, "Proportional gain", positive("N m/rad")
    )
    damping: float = setting(
        REQUIRED,
        "Derivative gain, which includes the damping of the joint",
        _at_least_zero("N m s/rad"),
    )
    torque: float = setting(REQUIRED, "Torque limit", positive("N m"))
    armature: float = setting(
        0.0,
        "Reflected rotor inertia {unit}; 0 to keep that of the model",
        _at_least_zero("kg m^2"),
    )


@dataclass(frozen=True, slots=True)
class SoleFrame:
    """Foot frame at the sole, under the ankle."""

    body: str = setting(REQUIRED, "Body of the foot")
    place: Place = setting(REQUIRED, "Origin in the frame of that body [m]")
    turn: Quaternion = setting(
        REQUIRED, "Orientation in the frame of that body, (w, x, y, z)"
    )


@dataclass(frozen=True, slots=True)
class Overlay:
    """Elements that are added to a published model when it is read."""

    soles: tuple[SoleFrame, ...] = setting(
        (), "Left and right foot frame; none without an overlay"
    )
    servos: dict[str, ServoGains] = setting(
        dict[str, ServoGains](), "Servo of each actuated joint"
    )
    meshes: tuple[str, ...] = setting(
        (), "Additional folders in which mesh files are looked up by name"
    )
    turn: Quaternion = setting(
        (1.0, 0.0, 0.0, 0.0),
        "Orientation of the published torso in axes forward, left, up, "
        "(w, x, y, z), for a model whose torso has other axes",
    )

    def __post_init__(self) -> None:
        if len(self.soles) != 2 and (self.soles or self.servos):
            raise ModelError(
                f"overlay.soles must have 2 entries, got {len(self.soles)}"
            )


NO_OVERLAY = Overlay()
