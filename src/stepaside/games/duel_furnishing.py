"""Scenery of a duel: obstacles, people and the cameras of robots."""

from functools import partial

from ..robots.description import load_robot
from ..robots.head import load_head
from ..sim.obstacle_geoms import add_solids, obstacle_mover
from ..sim.pedestrian_appearance import FIGURES
from ..sim.person_body import add_person
from ..sim.room_furnishing import Furnish, furnisher
from .duel_settings import EVADER, PURSUER, DuelSettings
from .game_furnishing import MakeMover, Scenery
from .initial_poses import wall_distance


def scenery_of_duel(settings: DuelSettings) -> Scenery:
    """Return obstacles, walls, objects, people and cameras of a duel.

    Args:
        settings: Settings of the duel, with the initial poses filled in.
    """
    furnishings: list[Furnish] = []
    movers: list[MakeMover] = []
    plan = settings.room.plan
    if settings.sensing == "cameras":
        furnishings.append(
            furnisher(
                settings.room,
                load_head(load_robot(settings.robot_of(EVADER).robot)),
                walls=wall_distance(settings),
                housings=(EVADER,),
                rear=settings.cameras.rear_camera,
                upper=settings.robots,
            )
        )
    if plan is not None:
        furnishings.append(lambda spec: add_solids(spec, plan))
        if plan.moving:
            movers.append(partial(obstacle_mover, room=plan))
    if settings.pursuer == "person":
        figure = FIGURES[settings.person.figure]
        solid = settings.person.solid
        furnishings.append(
            lambda spec: add_person(spec, PURSUER, figure, solid=solid)
        )
    return Scenery(tuple(furnishings), tuple(movers))
