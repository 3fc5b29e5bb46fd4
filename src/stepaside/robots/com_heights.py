"""Search of the heights of the CoM that legs reach, and what limits them."""

from collections.abc import Callable, Sequence

from ..core.poses import Array

# Search of CoM heights: relative step before bisection, resolution of the ends
# [m], and least height that is tried, relative to the standing angles.
HEIGHT_STEP, RESOLUTION, LEAST_HEIGHT = 0.05, 2e-4, 0.1
AT_LIMIT = 1e-3  # from the end of its range at which a joint is stopped, [rad]


def search_heights(
    reaches: Callable[[float], bool], natural: float
) -> tuple[float, float]:
    """Return least and greatest height that is reached [m], or zeros.

    The natural height, at the standing angles, lies between them.
    """
    begin = natural
    while not reaches(begin):
        begin *= 1.0 - HEIGHT_STEP
        if begin < LEAST_HEIGHT * natural:
            return 0.0, 0.0
    ends = []
    for factor in (1.0 - HEIGHT_STEP, 1.0 + HEIGHT_STEP):
        inside, outside = begin, factor * begin
        while reaches(outside) and outside > LEAST_HEIGHT * natural:
            inside, outside = outside, factor * outside
        while abs(outside - inside) > RESOLUTION:
            middle = 0.5 * (inside + outside)
            if reaches(middle):
                inside = middle
            else:
                outside = middle
        ends.append(inside)
    return ends[0], ends[1]


def stopped_joints(names: Sequence[str], angles: Array, limits: Array) -> str:
    """Name the joints at an end of their range, as the end of a message.

    Args:
        names: Joints.
        angles: Their angles, in [rad], and more. Shape (at least joints,).
        limits: Least and greatest angle, and more. Shape (joints, >= 2).
    """
    stopped = [
        f"{name!r} at {angle:.2f} rad ({low:.2f} to {high:.2f})"
        for name, angle, (low, high) in zip(
            names, angles[: len(names)], limits[:, :2].tolist(), strict=True
        )
        if min(angle - low, high - angle) < AT_LIMIT
    ]
    if not stopped:
        return ""
    return f"; at the end of its range: {', '.join(stopped)}"
