r"""Angles at which a leg stands bent, from where its pitch joints are.

Hip, knee and ankle pitch turn about the axis to the left, so that a leg is
two rods in a plane. A knee that bends by :math:`\kappa` away from where the
rods are in line leaves the hip to turn the ankle under itself, and the ankle
to level the foot. In the zero posture of most models the leg is straight and
the foot level; where it is not, their angles say so.
"""

from math import atan2, cos, sin

from .leg_detection import DetectedLeg

BENT = (-0.3, 0.6, -0.3)  # of hip, knee and ankle of a straight leg, [rad]
STRAIGHT = 0.05  # that a knee keeps from being straight, in [rad]
CROOKED = 0.25  # of a knee whose leg does not count as straight, in [rad]


def bend_of(leg: DetectedLeg, knee_range: tuple[float, float]) -> list[float]:
    """Angles of hip, knee and ankle of a leg that stands, in [rad].

    Args:
        leg: The leg.
        knee_range: Of its knee, in [rad].

    Returns:
        Of the joints themselves, whichever way their axes point.
    """
    hip, knee, ankle = BENT
    straight, tilt = straight_of(leg), tilt_of(leg)
    if straight or tilt:
        low, high = sorted(leg.signs[1] * end for end in knee_range)
        forward = min(straight + knee, high) - straight
        backward = straight - max(straight - knee, low)
        knee = straight + (knee if forward >= backward else -knee)
        upper, lower = _rods(leg)
        x = upper[0] + lower[0] * cos(knee) + lower[1] * sin(knee)
        z = upper[1] - lower[0] * sin(knee) + lower[1] * cos(knee)
        hip = atan2(x, -z)
        ankle = -tilt - hip - knee
    angles = (hip, knee, ankle)
    return [s * angle for s, angle in zip(leg.signs, angles, strict=True)]


def straight_of(leg: DetectedLeg) -> float:
    """Angle about the axis left at which a knee is straight, in [rad].

    Returns:
        0 for a leg that counts as straight in the zero posture.
    """
    upper, lower = (atan2(x, -z) for x, z in _rods(leg))
    straight = lower - upper
    return straight if abs(straight) > CROOKED else 0.0


def tilt_of(leg: DetectedLeg) -> float:
    """Pitch of a foot that stands against the zero posture, in [rad].

    Returns:
        About the axis left, by how far the foot of the zero posture is
        turned beyond level; 0 for one that is level.
    """
    x, _, z = leg.axes[:, 0]
    return atan2(-z, x) if z else 0.0


def _rods(leg: DetectedLeg) -> list[tuple[float, float]]:
    """Thigh and shank, forward and up, in [m]."""
    hip, knee, ankle = leg.pivots
    spans = (knee - hip, ankle - knee)
    return [(float(span[0]), float(span[2])) for span in spans]
