"""Everything but robots in the world of a duel: obstacles, people, cameras."""

from collections.abc import Callable

import mujoco

from ..robots.description import load_robot
from ..robots.head import load_head
from ..sim.obstacle_geoms import add_solids, obstacle_mover
from ..sim.passerby_bodies import add_passers, passer_mover
from ..sim.pedestrian_appearance import FIGURES
from ..sim.person_body import add_person
from ..sim.room_furnishing import Furnish, furnisher
from .duel_settings import EVADER, PLAYERS, PURSUER, DuelSettings
from .initial_poses import initial_poses, wall_distance

Mover = Callable[[float], None]  # moves bodies to where they are at a time [s]


def uses_lower_cameras(settings: DuelSettings) -> bool:
    """Return whether robots use the lower cameras of their heads.

    They serve to detect people and to map the floor.
    """
    maps = settings.room.plan is not None and settings.map.source == "seen"
    return settings.pursuer == "person" or maps


def furnishing_of(settings: DuelSettings) -> Furnish | None:
    """Return the function that adds everything but robots to a model.

    Args:
        settings: Settings of the duel, with the initial poses filled in.

    Returns:
        Function that adds obstacles, walls, objects, people and the cameras
        on robots; None if there is nothing to add.
    """
    furnishings: list[Furnish] = []
    if settings.sensing == "cameras":
        head = load_head(load_robot(settings.robot_of(EVADER).robot))
        low = settings.robots if uses_lower_cameras(settings) else ()
        walls = wall_distance(settings)
        furnishings.append(
            furnisher(
                settings.room,
                EVADER,
                head,
                walls=walls,
                upper=settings.robots,
                lower=low,
            )
        )
    plan = settings.room.plan
    if plan is not None:
        furnishings.append(lambda spec: add_solids(spec, plan))
    if settings.pursuer == "person":
        figure = FIGURES[settings.person.figure]
        furnishings += [
            lambda spec: add_person(spec, PURSUER, figure),
            lambda spec: add_passers(spec, settings.passers),
        ]

    def furnish(spec: mujoco.MjSpec) -> None:
        for add in furnishings:
            add(spec)

    return furnish if furnishings else None


def movers_in(
    settings: DuelSettings, model: mujoco.MjModel, data: mujoco.MjData
) -> list[Mover]:
    """Return the functions that move obstacles and passers of a duel.

    Args:
        settings: Settings of the duel, with the initial poses filled in.
        model: Model furnished by :func:`furnishing_of`.
        data: Its state.
    """
    movers: list[Mover] = []
    plan = settings.room.plan
    if plan is not None and plan.moving:
        movers.append(obstacle_mover(model, data, plan))
    if settings.passers:
        evader = initial_poses(settings)[PLAYERS.index(EVADER)]
        movers.append(passer_mover(model, data, settings.passers, evader))
    return movers
