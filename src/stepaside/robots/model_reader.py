"""Reader of published MJCF and URDF files, including outdated ones."""

from pathlib import Path

import mujoco

from ..core.errors import ModelError

SUFFIXES = (".xml", ".urdf")  # that MuJoCo accepts for model files


def read_model(path: Path) -> mujoco.MjSpec:
    """Read an MJCF or URDF file as an editable model, or ModelError.

    Attributes of physics and rendering that MuJoCo lacks are ignored.
    """
    path = path.resolve()  # MuJoCo does not find includes of a relative path
    failed = None
    if path.suffix in SUFFIXES:
        try:
            return mujoco.MjSpec.from_file(str(path))
        except ValueError as error:
            failed = error
    from .outdated_model import read_outdated

    try:
        return read_outdated(path, failed)
    except ValueError as error:
        raise ModelError(f"{path} is not a MuJoCo model: {error}") from error


def motors_of(model: mujoco.MjModel, name: str, remedy: str) -> set[str]:
    """Return the names of the joints of a robot that have an actuator."""
    motors: set[str] = set()
    for i in range(model.nu):
        if model.actuator_trntype[i] != mujoco.mjtTrn.mjTRN_JOINT:
            raise ModelError(
                f"actuator {model.actuator(i).name!r} of {name} must move a "
                f"joint; {remedy}"
            )
        joint = model.joint(model.actuator_trnid[i, 0]).name
        if joint in motors:
            raise ModelError(
                f"joint {joint!r} of {name} must have one actuator, got "
                f"several; {remedy}"
            )
        motors.add(joint)
    return motors
