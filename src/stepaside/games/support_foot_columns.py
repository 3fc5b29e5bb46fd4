"""Walk in the frame of the support foot.

Odometry drifts from the world by slip. Therefore references, estimates and
true values are compared in the frame of the support foot.
"""

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from .outcome import Outcome
from .trajectory import Trajectory


def express_in_support_foot(
    times: Array, track: Trajectory
) -> dict[str, Array]:
    """Express a walk in the frame of the support foot.

    True quantities are in the frame of the true sole, references and
    estimates in that of the planned sole, unless their names say otherwise.
    References in the world are those of odometry, placed there at its start.

    Args:
        times: Times of the samples, in [s]. Shape (n,).
        track: Trajectory with foot states and estimates.

    Returns:
        Columns by name: ``time``, ``support``, ``single``, angles, and x and
        y of each other quantity, like ``com_x``. Shape (n,) each.

    Raises:
        ValueError: If the trajectory has no foot states.
    """
    sole, support, tilt = track.sole, track.support, track.tilt
    if sole is None or support is None or tilt is None:
        raise ValueError("the trajectory must have sole, support and tilt")
    com, planned = track.com[:, :2], support[:, 2:]
    estimate = track.estimate
    if estimate is None:
        estimate = np.full((len(times), 8), np.nan)
    pairs = {
        "com": _point(sole, com),
        "velocity": _vector(sole, track.velocity),
        "com_reference": _point(planned, track.com_reference),
        "zmp": _point(sole, track.zmp),
        "zmp_reference": _point(planned, track.zmp_reference),
        "estimated_com": _point(planned, estimate[:, 0:2]),
        "estimated_velocity": _vector(planned, estimate[:, 2:4]),
        "estimated_zmp": _point(planned, estimate[:, 4:6]),
        "com_in_world": com,
        "com_reference_in_world": track.com_reference,
        "foot_in_world": sole[:, :2],
    }
    found = {"time": times, "support": support[:, 0], "single": support[:, 1]}
    for name, points in pairs.items():
        assert points is not None
        found |= {f"{name}_x": points[:, 0], f"{name}_y": points[:, 1]}
    found |= {"roll": tilt[:, 0], "pitch": tilt[:, 1]}
    found |= {
        "estimated_roll": estimate[:, 6],
        "estimated_pitch": estimate[:, 7],
    }
    assert track.heading_reference is not None
    found["heading"] = track.torso[:, 2]
    found["heading_reference"] = track.heading_reference[:, 0]
    return found


def upright_samples(
    times: Array, outcome: Outcome | None
) -> NDArray[np.bool_]:
    """Return a mask of the evenly spaced samples of an upright robot.

    The last sample is at the end of the game, which may come between two
    periods or after a fall.

    Args:
        times: Times of the samples, in [s]. Shape (n,).
        outcome: How the game ended.

    Returns:
        Mask. Shape (n,).
    """
    mask: NDArray[np.bool_] = np.ones(len(times), dtype=bool)
    if len(times) > 2:
        period = times[1] - times[0]
        mask[-1] = abs(times[-1] - times[-2] - period) < 0.1 * period
    if outcome in (Outcome.FALL, Outcome.CONTACT):
        mask[-1:] = False
    return mask


def _point(frames: Array, points: Array | None) -> Array:
    """Transform points from the world to frames. Shape (n, 2)."""
    assert points is not None
    return _vector(frames, points - frames[:, :2])


def _vector(frames: Array, vectors: Array | None) -> Array:
    """Rotate vectors from the world to frames. Shape (n, 2)."""
    assert vectors is not None
    c, s = np.cos(frames[:, 2]), np.sin(frames[:, 2])
    x, y = vectors[:, 0], vectors[:, 1]
    return np.column_stack([c * x + s * y, c * y - s * x])
