"""Claims of Sec. III-E and IV, measured on two NAOs in physics."""

from math import pi, sqrt

from .claims import Claim
from .physics_measurements import SLIPPERY

LEVEL = "physics"
SPEED, GAIN = 0.1, 0.2  # of Sec. IV, in [m/s] and [1/s]
SINGLE, DOUBLE = 0.425, 0.122  # support, exchanged, in [s]
STRIDE, STEP = 0.04, SINGLE + DOUBLE
RADIUS = 4.0 * SPEED / (pi * GAIN)
DISTANCE = sqrt(2.0) * RADIUS
START = 0.8  # double support before the first step, in [s]
WALK = 30.0  # simulated time of the walks of "durations", in [s]


CIRCLE = tuple(
    Claim(key, text, "IV, Fig. 5", LEVEL, expected, unit, tolerance)
    for key, text, expected, unit, tolerance in (
        (
            "pursuer_radius",
            "the pursuer converges to a circle (of the last third)",
            RADIUS,
            "m",
            0.04 * RADIUS,
        ),
        (
            "evader_radius",
            "the evader converges to a circle",
            RADIUS,
            "m",
            0.04 * RADIUS,
        ),
        (
            "one_circle",
            "both circles coincide (distance of the centres)",
            0.0,
            "m",
            0.02,
        ),
        (
            "distance",
            "their distance converges",
            DISTANCE,
            "m",
            0.04 * DISTANCE,
        ),
        (
            "orientation",
            "their relative orientation is pi/2",
            90.0,
            "deg",
            3.0,
        ),
        (
            "same_speed",
            "they travel along it at the same speed (ratio)",
            1.0,
            "1",
            0.04,
        ),
    )
)
REPLANNING = (
    Claim(
        "settled",
        "they converge before the last third of the run (time from which "
        "distance and orientation stay within 5 % and 5 deg of theory)",
        "IV, Fig. 5",
        LEVEL,
        80.0,
        "s",
        relation="<",
    ),
    Claim(
        "landings",
        "feet land every 0.547 s (by the foot forces; the interval farthest "
        "from it)",
        "III-E, IV",
        LEVEL,
        STEP,
        "s",
        0.02,
    ),
    Claim(
        "both_feet",
        "a new plan follows each landing, and replaces the old one while "
        "both feet are on the ground (fraction of the plans, by the foot "
        "forces; the plan unloads one foot at that moment, so a foot "
        "unloaded less than 30 ms before counts as on the ground)",
        "III-E",
        LEVEL,
        1.0,
        "1",
    ),
    Claim(
        "at_its_end",
        "namely at the end of double support (longest time from a plan to "
        "the next lift-off; a double support lasts 0.122 s)",
        "III-E",
        LEVEL,
        0.5 * DOUBLE,
        "s",
        relation="<",
    ),
    Claim(
        "straight_part",
        "the straight part is never travelled (largest fraction of t_s for "
        "which a plan was walked before it was replaced)",
        "III-E",
        LEVEL,
        1.0,
        "1",
        relation="<",
    ),
    Claim(
        "place_jump",
        "replanning does not destabilise (largest jump of the CoM reference "
        "of the joint targets)",
        "III-E",
        LEVEL,
        0.0,
        "m",
        1e-8,
    ),
    Claim(
        "velocity_jump",
        "nor does the velocity of that reference jump (by finite differences)",
        "III-E",
        LEVEL,
        0.0,
        "m/s",
        1e-6,
        as_printed="(15) alone lets the velocity jump by eta times the "
        "change of x_u",
    ),
)
HUMANOIDS = CIRCLE + REPLANNING
DURATIONS = (
    Claim(
        "printed_slide",
        "with single support 0.122 s and double support 0.425 s the joints "
        "are too slow, and the stance feet slip (ratio of their slip "
        "distance per step to that with the durations exchanged)",
        "IV",
        LEVEL,
        1.0,
        "1",
        relation=">",
        as_printed="single and double support of 0.122 s and 0.425 s",
    ),
    Claim(
        "printed_tilt",
        "and the torso sways (ratio of its largest tilt angles, likewise)",
        "IV",
        LEVEL,
        3.0,
        "1",
        relation=">",
    ),
    Claim(
        "upright_for",
        "with the durations exchanged they walk to the end (time walked)",
        "IV",
        LEVEL,
        WALK,
        "s",
        1e-6,
    ),
    Claim(
        "tilt",
        "upright (greatest angle of a torso from the vertical)",
        "IV",
        LEVEL,
        10.0,
        "deg",
        relation="<",
    ),
    Claim(
        "distance",
        "and advance (distance walked by the robot that walks less far)",
        "IV",
        LEVEL,
        STRIDE / STEP * (WALK - START),
        "m",
        0.05 * STRIDE / STEP * (WALK - START),
    ),
    Claim(
        "speed",
        "at 0.04 m every 0.547 s, slower than the path's 0.1 m/s (the speed "
        "farther from it)",
        "IV",
        LEVEL,
        STRIDE / STEP,
        "m/s",
        0.004,
        as_printed="0.1 m/s",
    ),
)
SLIP = (
    Claim(
        "slide",
        f"on a floor with friction {SLIPPERY} feet slip more than on one "
        "with 0.8 (ratio of their slip distances per step)",
        "IV, Fig. 6",
        LEVEL,
        1.0,
        "1",
        relation=">",
    ),
    Claim(
        "slower",
        "the robots are slower (ratio of the speeds)",
        "IV, Fig. 6",
        LEVEL,
        1.0,
        "1",
        relation="<",
    ),
    Claim(
        "smaller",
        "and their circle is smaller (ratio of the radii)",
        "IV, Fig. 6",
        LEVEL,
        1.0,
        "1",
        relation="<",
    ),
)
