"""A walk seen from the support foot.

Odometry and the world drift apart by slip, so what was asked, what was
estimated and what is true are compared in the frame of the support foot.
"""

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from .outcome import Outcome
from .trajectory import Trajectory

COLUMNS = (
    *("time", "support", "single", "com_x", "com_y", "velocity_x"),
    *("velocity_y", "reference_x", "reference_y", "zmp_x", "zmp_y"),
    *("zmp_reference_x", "zmp_reference_y", "roll", "pitch"),
    *("estimated_com_x", "estimated_com_y", "estimated_velocity_x"),
    *("estimated_velocity_y", "estimated_zmp_x", "estimated_zmp_y"),
    *("estimated_roll", "estimated_pitch"),
    *("world_x", "world_y", "heading", "asked_x", "asked_y"),
    *("asked_heading", "foot_x", "foot_y"),
)


def seen_from_foot(times: Array, track: Trajectory) -> dict[str, Array]:
    """Columns of a walk, by the names of ``COLUMNS``. Shape (n,) each.

    What is true is seen from the true sole, what is asked or estimated from
    where the plan has it.

    Args:
        times: Of the samples, in [s]. Shape (n,).
        track: Record of a robot that was looked at closely.

    Raises:
        ValueError: If it was not.
    """
    sole, support, tilt = track.sole, track.support, track.tilt
    if sole is None or support is None or tilt is None:
        raise ValueError("a walk is seen from its foot if the record has it")
    com, place = track.com[:, :2], support[:, 2:]
    estimate = track.estimate
    if estimate is None:
        estimate = np.full((len(times), 8), np.nan)
    pairs = {
        "com": _point(sole, com),
        "velocity": _turned(sole, track.velocity),
        "reference": _point(place, track.com_reference),
        "zmp": _point(sole, track.zmp),
        "zmp_reference": _point(place, track.zmp_reference),
        "estimated_com": _point(place, estimate[:, 0:2]),
        "estimated_velocity": _turned(place, estimate[:, 2:4]),
        "estimated_zmp": _point(place, estimate[:, 4:6]),
        "world": com,
        "asked": track.com_reference,
        "foot": sole[:, :2],
    }
    found = {"time": times, "support": support[:, 0], "single": support[:, 1]}
    for name, points in pairs.items():
        assert points is not None
        found |= {f"{name}_x": points[:, 0], f"{name}_y": points[:, 1]}
    found |= {"roll": tilt[:, 0], "pitch": tilt[:, 1]}
    found |= {f"estimated_{n}": estimate[:, 6 + i] for i, n in _LEANS}
    assert track.heading_reference is not None
    found["heading"] = track.torso[:, 2]
    found["asked_heading"] = track.heading_reference[:, 0]
    return {name: found[name] for name in COLUMNS}


def on_its_feet(times: Array, outcome: Outcome) -> NDArray[np.bool_]:
    """Which samples are evenly spaced ones of a robot that does not lie.

    The last sample of a game is of the instant at which it ended, whenever
    that was. Shape (n,).
    """
    right: NDArray[np.bool_] = np.ones(len(times), dtype=bool)
    if len(times) > 2:
        period = times[1] - times[0]
        right[-1] = abs(times[-1] - times[-2] - period) < 0.1 * period
    if outcome in (Outcome.FALL, Outcome.CONTACT):
        right[-1:] = False
    return right


_LEANS = tuple(enumerate(("roll", "pitch")))


def _point(frames: Array, points: Array | None) -> Array:
    """Points as seen in frames, sample by sample. Shape (n, 2)."""
    assert points is not None
    return _turned(frames, points - frames[:, :2])


def _turned(frames: Array, vectors: Array | None) -> Array:
    """Vectors as seen in frames, sample by sample. Shape (n, 2)."""
    assert vectors is not None
    c, s = np.cos(frames[:, 2]), np.sin(frames[:, 2])
    x, y = vectors[:, 0], vectors[:, 1]
    return np.column_stack([c * x + s * y, c * y - s * x])
