"""How soon a walk may change its pace."""

QUICKENING = 0.25  # most that the pace changes from step to step


def next_pace(before: float, wanted: float, *, standing: bool) -> float:
    """Pace of the next step.

    Steps in less time need the CoM less far to the side. What the last step
    prepared for is made good by the correction of the next plan, which is
    a ZMP shift, and that has to stay well inside the sole.

    Args:
        before: Pace of the last step.
        wanted: Pace that is asked for.
        standing: Whether the robot stands: then nothing was prepared.
    """
    if standing:
        return wanted
    return min(max(wanted, before - QUICKENING), before + QUICKENING)
