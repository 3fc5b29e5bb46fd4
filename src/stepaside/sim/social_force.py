"""Social force model of people among others.

Acceleration of a walker by M. Moussaid et al., "Experimental study of the
behavioural mechanisms underlying self-organization in human crowds"
(Proceedings of the Royal Society B 276, 2009), with the factors of the public
implementations pedsim_ros, lightsfm and PySocialForce.
"""

from math import atan2, cos, exp, hypot, sin, tanh

from ..core.poses import wrap_angle

RELAXATION = 0.5  # time to reach the desired velocity, in [s]
STRENGTH = 5.1  # of the force from another walker, in [m/s^2]
ANTICIPATION = 2.0  # weight of the relative velocity, in [s/m]
REACH = 0.35  # of the force per magnitude of the interaction, in [m]
NARROWING = 3.0  # of deceleration with the angle, in [1/(m rad)]
TURNING = 2.0  # likewise of turning aside
PREFERENCE = 0.005  # for passing on the right, in [rad/m]
OBSTACLE = 10.0  # force at contact with an obstacle, in [m/s^2]
OBSTACLE_RANGE = 0.2  # in which it decays by e, in [m]
COHESION = 3.0  # force towards the middle of a group, in [m/s^2]
SPACING = 0.55  # distance below which members of a group part, in [m]
Vector = tuple[float, float]


def social_force(
    offset: Vector, relative_velocity: Vector, preference: float = PREFERENCE
) -> Vector:
    """Return the acceleration [m/s^2] of a walker by another one.

    Offset and velocity are relative to the other. Both tend to the right by
    the preference; without, two who meet head-on only slow down.
    """
    distance = hypot(*offset)
    if distance == 0.0:
        return 0.0, 0.0
    x = offset[0] / distance - ANTICIPATION * relative_velocity[0]
    y = offset[1] / distance - ANTICIPATION * relative_velocity[1]
    interaction = hypot(x, y)
    reach = REACH * interaction
    if reach == 0.0:
        return 0.0, 0.0
    along = atan2(y, x)
    angle = wrap_angle(along - atan2(offset[1], offset[0]))
    angle -= reach * preference
    decay = -distance / reach
    slows = STRENGTH * exp(decay - (NARROWING * reach * angle) ** 2)
    turns = STRENGTH * exp(decay - (TURNING * reach * angle) ** 2)
    turns = -turns if angle > 0.0 else turns if angle < 0.0 else 0.0
    c, s = cos(along), sin(along)
    return slows * c - turns * s, slows * s + turns * c


def desired_force(
    offset: Vector, velocity: Vector, speed: float, halts_within: float
) -> Vector:
    """Return the acceleration [m/s^2] towards a goal at an offset [m]."""
    distance = hypot(*offset)
    scale = speed / distance if distance > halts_within else 0.0
    return (
        (scale * offset[0] - velocity[0]) / RELAXATION,
        (scale * offset[1] - velocity[1]) / RELAXATION,
    )


def obstacle_force(outward: Vector, gap: float) -> Vector:
    """Return the acceleration [m/s^2] away from an obstacle at a gap [m]."""
    push = OBSTACLE * exp(-max(gap, 0.0) / OBSTACLE_RANGE)
    return push * outward[0], push * outward[1]


def group_force(place: Vector, members: list[Vector]) -> Vector:
    """Return the acceleration [m/s^2] of a walker by its group."""
    if not members:
        return 0.0, 0.0
    count = len(members) + 1
    x = (place[0] + sum(m[0] for m in members)) / count - place[0]
    y = (place[1] + sum(m[1] for m in members)) / count - place[1]
    scale = 0.5 * COHESION * (1.0 + tanh(hypot(x, y) - 0.5 * (count - 1)))
    x, y = scale * x, scale * y
    for member in members:
        dx, dy = place[0] - member[0], place[1] - member[1]
        if hypot(dx, dy) < SPACING:
            x, y = x + dx, y + dy
    return x, y
