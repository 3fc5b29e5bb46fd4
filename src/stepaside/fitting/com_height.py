"""CoM height and step length of a robot, from its joint limits."""

from dataclasses import replace

from ..core.errors import ModelError, ReachError
from ..games.robot_settings import settings_from_description
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..robots.leg_kinematics import BodyReference, LegKinematics
from .gait_feasibility import feasible_lengths
from .gait_scaling import RobotSize, gait_of

# CoM heights that are tried, as fractions of the greatest one in reach: the
# lower, the farther a knee is from straight at the end of a step.
HEIGHT_FRACTIONS = (0.96, 0.94, 0.92, 0.9)
LEAST_GAIN = 0.05  # in step length, which justifies a lower CoM
TICK = 0.004  # of the kinematics that tries heights, in [s]


def choose_com_height(
    description: RobotDescription, size: RobotSize, lowest: float
) -> tuple[RobotSize, float]:
    """Choose the CoM height at which the joints are fast enough.

    Knee speed grows without bound as a knee gets straight, so that lower
    heights are tried if the speed limits are exceeded.

    Args:
        description: Robot description.
        size: Size of the robot at the greatest height in reach.
        lowest: Least height in reach, in [m].

    Returns:
        Size at the chosen height, and the feasible fraction of the nominal
        stride and step height.
    """
    best: tuple[RobotSize, float] | None = None
    for fraction in HEIGHT_FRACTIONS:
        height = fraction * size.com_height
        if best is not None and height < lowest:
            break
        candidate = replace(size, com_height=height)
        lengths = feasible_lengths(*with_gait(description, gait_of(candidate)))
        if best is None or lengths > best[1] + LEAST_GAIN:
            best = candidate, lengths
        if lengths == 1.0:
            break
    assert best is not None
    return best


def with_gait(
    description: RobotDescription, gait: dict[str, float]
) -> tuple[RobotDescription, GaitSettings]:
    """Return the description with gait entries, and the gait settings."""
    changed = replace(description, gait=dict(gait))
    return changed, settings_from_description(changed).gait


def reachable_heights(
    description: RobotDescription,
    spacing: float,
    sole: tuple[float, float, float, float],
    stiff: list[str],
) -> tuple[float, float]:
    """Return least and greatest CoM height with the feet abreast, in [m].

    Args:
        description: Robot description.
        spacing: Distance between the feet, in [m].
        sole: Edges back, front, outer and inner of a sole, in [m].
        stiff: Leg joints whose range excludes the standing angle.

    Raises:
        ModelError: If no height is reached; names the stiff joints.
    """
    forward = 0.45 * (sole[0] + sole[1])
    half = 0.5 * spacing
    stance = BodyReference(
        (forward, 0.0, 1.0), (0.0, half, 0.0, 0.0), (0.0, -half, 0.0, 0.0)
    )
    kinematics = LegKinematics(description, tick=TICK)
    lowest, highest = kinematics.com_heights(stance)
    if highest == 0.0:
        try:
            kinematics.stand(stance)
        except ReachError as error:
            reason = str(error)
            if stiff:
                reason = f"see the ranges of {', '.join(stiff)}, which do "
                reason += "not allow bent knees"
            raise ModelError(
                f"{description.name} can stand at no height with its feet "
                f"{spacing:.3f} m apart: {reason}"
            ) from error
    return lowest, highest
