"""A duel's pursuer that may be a person."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, cast

import mujoco

from ..control import ControlScheme
from ..poses import Pose
from ..world.person import Person, PersonMind, add_person
from ..world.person_motion import Motion
from ..world.robot import SimulatedRobot
from ..world.world import World
from .settings import DuelSettings

if TYPE_CHECKING:
    from .seeing import Seeing

ROBOTS = ("pursuer", "evader")
PERSON = "pursuer"


def walkers_of(settings: DuelSettings) -> tuple[str, ...]:
    """Names of those that are robots."""
    return ROBOTS if settings.pursuer == "robot" else ("evader",)


def furnisher_of(
    settings: DuelSettings, seeing: "Seeing | None"
) -> Callable[[mujoco.MjSpec], None] | None:
    """What is put into the world besides the robots, if anything is."""
    furnish = None if seeing is None else seeing.furnish
    if settings.pursuer == "robot":
        return furnish

    def both(spec: mujoco.MjSpec) -> None:
        if furnish is not None:
            furnish(spec)
        add_person(spec, PERSON)

    return both


def stand_person(
    world: World,
    name: str,
    settings: DuelSettings,
    frames: Sequence[Pose],
) -> tuple[SimulatedRobot, ControlScheme]:
    """Stand a person where the pursuing robot would stand.

    Args:
        world: World that has the figure.
        name: Its name there.
        settings: Of the duel.
        frames: Where pursuer and evader stand.
    """
    motion = Motion(settings.person, frames[0], frames[1][:2])
    person = Person(world, name, motion)
    # It stands in the place of a robot wherever a duel has one.
    return (
        cast(SimulatedRobot, person),
        cast(ControlScheme, PersonMind(settings.gait)),
    )


def meet(robots: Sequence[SimulatedRobot]) -> None:
    """Let a person know the evader, if there is a person."""
    for robot in robots:
        if isinstance(robot, Person):
            robot.meet(robots[1].truth)
