"""How high a stranger's robot carries its CoM, and how long its steps are."""

from dataclasses import replace

from ..core.errors import ModelError, ReachError
from ..games.robot_settings import settings_of
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..robots.leg_kinematics import BodyReference, LegKinematics
from .gait_feasibility import lengths_share
from .gait_scaling import RobotSize, gait_of

# Of the greatest height that is reached, by which steps are tried: the less,
# the farther a knee is from being straight at the end of a step.
HEIGHTS = (0.96, 0.94, 0.92, 0.9)
LONGER = 0.05  # share of a step that makes standing lower worth it
TICK = 0.004  # of the kinematics that tries heights, in [s]


def stature_of(
    description: RobotDescription, size: RobotSize, lowest: float
) -> tuple[RobotSize, float]:
    """Size of a robot at the height where it walks, and share of its steps.

    Knees that get straight in a step are fast without end. Where the joints
    would have to be faster than they are, it is tried lower.

    Args:
        description: The robot.
        size: Its size at the greatest height that it reaches.
        lowest: Least height that it reaches, in [m].
    """
    best: tuple[RobotSize, float] | None = None
    for part in HEIGHTS:
        height = part * size.com_height
        if best is not None and height < lowest:
            break
        tried = replace(size, com_height=height)
        share = lengths_share(*rehearsed(description, gait_of(tried)))
        if best is None or share > best[1] + LONGER:
            best = tried, share
        if share == 1.0:
            break
    assert best is not None
    return best


def rehearsed(
    description: RobotDescription, gait: dict[str, float]
) -> tuple[RobotDescription, GaitSettings]:
    """A robot and its gait, to go through."""
    made = replace(description, gait=dict(gait))
    return made, settings_of(made).gait


def heights_of(
    description: RobotDescription,
    spacing: float,
    sole: tuple[float, float, float, float],
    stiff: list[str],
) -> tuple[float, float]:
    """Least and greatest height of the CoM with the feet abreast, in [m].

    Raises:
        ModelError: If there is none; names joints that do not bend.
    """
    ahead = 0.45 * (sole[0] + sole[1])
    half = 0.5 * spacing
    stance = BodyReference(
        (ahead, 0.0, 1.0), (0.0, half, 0.0, 0.0), (0.0, -half, 0.0, 0.0)
    )
    kinematics = LegKinematics(description, tick=TICK)
    highest = kinematics.highest_com(stance)
    if highest == 0.0:
        try:
            kinematics.stand(stance)
        except ReachError as error:
            why = str(error)
            if stiff:
                why = f"see the ranges of {', '.join(stiff)}, which cannot "
                why += "bend as legs with bent knees do"
            raise ModelError(
                f"{description.name} can stand at no height with its feet "
                f"{spacing:.3f} m apart: {why}"
            ) from error
    return kinematics.lowest_com(stance), highest
