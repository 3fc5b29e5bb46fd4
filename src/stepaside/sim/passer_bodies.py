"""Figures of those who pass, where their walks have them."""

from collections.abc import Callable, Sequence

import mujoco

from ..core.poses import Pose
from .passer_settings import Passer
from .pedestrian_models import FIGURES
from .person_body import add_person, parts_of, pose_figure


def add_passers(spec: mujoco.MjSpec, passers: Sequence[Passer]) -> None:
    """Put their figures into a world, to be moved.

    Args:
        spec: World.
        passers: Who they are.
    """
    for number, passer in enumerate(passers, start=1):
        add_person(spec, _name(number), FIGURES[passer.figure])


def passer_mover(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    passers: Sequence[Passer],
    evader: Pose,
) -> Callable[[float], None]:
    """What puts them where they are at a time, in [s].

    Args:
        model: World that has them.
        data: Its state.
        passers: Who they are.
        evader: Where the evader stands at first, in the world.
    """
    parts = [parts_of(model, _name(i + 1)) for i in range(len(passers))]

    def move(time: float) -> None:
        for own, passer in zip(parts, passers, strict=True):
            pose, way = passer.pose_at(time, evader), passer.speed * time
            pose_figure(data, own, pose, way, FIGURES[passer.figure])

    return move


def _name(number: int) -> str:
    """Prefix of the bodies of a passer; what touches one is told so."""
    return f"passer {number}"
