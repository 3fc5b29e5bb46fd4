"""Bodies of passers-by in a world, moved along their walks."""

from collections.abc import Callable, Sequence

import mujoco

from ..core.poses import Pose
from .passerby_settings import Passer
from .pedestrian_appearance import FIGURES
from .person_body import add_person, mocap_indices, set_person_pose


def add_passers(spec: mujoco.MjSpec, passers: Sequence[Passer]) -> None:
    """Add the bodies of passers-by to a world.

    Args:
        spec: Specification of the world.
        passers: The passers-by.
    """
    for number, passer in enumerate(passers, start=1):
        add_person(spec, _name(number), FIGURES[passer.figure])


def passer_mover(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    passers: Sequence[Passer],
    evader: Pose,
) -> Callable[[float], None]:
    """Return the function that moves the bodies of passers-by.

    Args:
        model: Model of the world.
        data: Its state.
        passers: The passers-by.
        evader: Initial pose of the evader in the world.

    Returns:
        Function of the time, in [s].
    """
    parts = [mocap_indices(model, _name(i + 1)) for i in range(len(passers))]

    def move(time: float) -> None:
        for own, passer in zip(parts, passers, strict=True):
            pose = passer.pose_at(time, evader)
            walked = passer.speed * time
            set_person_pose(data, own, pose, walked, FIGURES[passer.figure])

    return move


def _name(number: int) -> str:
    """Return the prefix of the bodies of a passer-by, shown in contacts."""
    return f"passer {number}"
