r"""Standing angles of a leg with a bent knee.

Hip, knee and ankle pitch have parallel lateral axes, so that a leg is a
planar two-link chain. The knee bends by :math:`\kappa` from the straight leg,
the hip puts the ankle under itself, and the ankle levels the foot. In the
zero posture of most models the leg is straight and the foot level; if not,
their angles are taken into account.
"""

from math import atan2, cos, sin

from .leg_detection import DetectedLeg

BENT = (-0.3, 0.6, -0.3)  # hip, knee and ankle of a straight leg, in [rad]
STRAIGHT_MARGIN = 0.05  # least bend of a knee, in [rad]
STRAIGHT_TOLERANCE = 0.25  # smaller knee angles count as straight, in [rad]


def bend_of(leg: DetectedLeg, knee_range: tuple[float, float]) -> list[float]:
    """Return the standing angles of hip, knee and ankle.

    Args:
        leg: Detected leg.
        knee_range: Range of its knee, in [rad].

    Returns:
        Joint angles, in [rad], signed by the joint axes of the model.
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
    """Return the knee angle of the straight leg.

    Returns:
        Angle about the axis to the left, in [rad]; 0 if the leg is about
        straight in the zero posture.
    """
    upper, lower = (atan2(x, -z) for x, z in _rods(leg))
    straight = lower - upper
    return straight if abs(straight) > STRAIGHT_TOLERANCE else 0.0


def tilt_of(leg: DetectedLeg) -> float:
    """Return the pitch of the sole in the zero posture.

    Returns:
        Angle from level about the axis to the left, in [rad].
    """
    x, _, z = leg.axes[:, 0]
    return atan2(-z, x) if z else 0.0


def _rods(leg: DetectedLeg) -> list[tuple[float, float]]:
    """Return thigh and shank vectors (forward, up), in [m]."""
    hip, knee, ankle = leg.pivots
    spans = (knee - hip, ankle - knee)
    return [(float(span[0]), float(span[2])) for span in spans]
