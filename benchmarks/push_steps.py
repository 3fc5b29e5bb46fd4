"""What the push bound leaves out: more footsteps, and earlier ones.

At times and directions over a step of a straight walk under way, the bound
for one footstep that lands when planned is compared with the bound for many
footsteps, and with that for a footstep that may land at any time up to the
planned one::

    python benchmarks/push_steps.py
"""

from math import cos, sin, tau

import numpy as np
from asking import ask

from stepaside.planning import (
    PRESETS,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from stepaside.planning.capture import (
    Reach,
    held_regions,
    push_bound,
    ray_interval,
)
from stepaside.planning.steady import steady_plan
from stepaside.studies.results import header, write_result
from stepaside.studies.survival import walking_reach
from stepaside.studies.version import PLANNER

TIMES, DIRECTIONS, LANDINGS = 16, 48, 12
FOOTSTEPS = 4  # one more counts by exp(-eta T), 0.04 or less
MASS = 5.3  # [kg]; the ratios are free of it
GAITS = {"paper": GaitSettings(), "fast": PRESETS["fast"]}
WALKS = {"forward": Direction.FORWARD, "backward": Direction.BACKWARD}


def landing_early(
    plan: ManeuverPlan, time: float, direction: float, reach: Reach
) -> float:
    """Bound for one footstep that lands at its time or before, in [N s]."""
    end = next(p.end for p in plan.support() if p.end > time)
    dcm = plan.sample([time]).dcm[0]
    heading = np.array([cos(direction), sin(direction)])
    regions = held_regions(plan, time, reach, 1)
    for later in np.linspace(time, end, LANDINGS, endpoint=False)[1:]:
        regions += held_regions(plan, float(later), reach, 1)[1:]
    # At the end of the phase the foot lands at once.
    shift = 0.0
    for enter, leave in sorted(ray_interval(dcm, heading, r) for r in regions):
        if enter <= shift:
            shift = max(shift, leave)
    eta = plan.schedule.settings.eta
    return float(MASS * eta * shift)


def main() -> None:
    """Compare bounds at all times and directions."""
    output = ask(__doc__, "push-steps.json").parse_args().output
    reach = walking_reach()
    rows = []
    for name, gait in GAITS.items():
        for walk, way in WALKS.items():
            plan = steady_plan(
                ManeuverPlanner(gait), 0.0, way, first_foot=Foot.LEFT
            )
            many, early = {}, {}
            end = plan.schedule.first_step_duration
            for time in np.linspace(0.0, end, TIMES, endpoint=False).tolist():
                single = next(p for p in plan.support() if p.end > time).single
                for angle in np.linspace(
                    0.0, tau, DIRECTIONS, endpoint=False
                ).tolist():
                    one = push_bound(plan, time, angle, MASS, reach)
                    if one <= 0.0:
                        continue
                    case = time, angle
                    many[case] = (
                        push_bound(
                            *(plan, time, angle, MASS, reach), steps=FOOTSTEPS
                        )
                        / one
                    )
                    if single:
                        early[case] = (
                            landing_early(plan, time, angle, reach) / one
                        )
            along = [many[c] for c in many if abs(sin(c[1])) < 1e-9]
            aside = [many[c] for c in many if abs(cos(c[1])) < 1e-9]
            rows.append(
                {
                    "gait": name,
                    "walk": walk,
                    "more_steps_most": max(many.values()) - 1.0,
                    "more_steps_along": max(along) - 1.0,
                    "more_steps_aside": max(aside) - 1.0,
                    "earlier_most": max(early.values()),
                    "earlier_median": float(np.median(list(early.values()))),
                }
            )
    settings = {
        "times": TIMES,
        "directions": DIRECTIONS,
        "landings": LANDINGS,
        "footsteps": FOOTSTEPS,
        "reach_m": reach._asdict(),
    }
    rooms = (*PLANNER, "studies/survival")
    head = header(settings, rooms=rooms, libraries=("numpy",))
    write_result(output, head, rows=rows)


if __name__ == "__main__":
    main()
