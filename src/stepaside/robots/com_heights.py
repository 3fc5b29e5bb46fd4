"""Search of the heights of the CoM that legs reach."""

from collections.abc import Callable

# Search of CoM heights: relative step before bisection, resolution of the ends
# [m], and least height that is tried, relative to the standing angles.
HEIGHT_STEP, RESOLUTION, LEAST_HEIGHT = 0.05, 2e-4, 0.1


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
