"""Measure what the push bound omits: more footsteps, and earlier ones.

At times and directions over a step of a steady walk, for an impulse, compare
the bound for one footstep that lands as planned with the bounds for many
footsteps and for a footstep that lands at any time up to the planned one::

    python tools/benchmarks/push_steps.py
"""

from math import cos, pi, sin, tau

import numpy as np
from benchmark_options import ask

from stepaside.core.poses import Array
from stepaside.planning import (
    PRESETS,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from stepaside.planning.capturability import (
    FootReach,
    held_regions,
    ray_interval,
)
from stepaside.planning.steady_gait import steady_plan
from stepaside.studies.code_version import PLANNER
from stepaside.studies.result_files import header, write_result
from stepaside.studies.survival_statistics import foot_reach

TIMES, DIRECTIONS, LANDINGS = 60, 180, 24
FOOTSTEPS = 4  # a further step is weighted by exp(-eta T), 0.04 or less
GAITS = {"paper": GaitSettings(), "fast": PRESETS["fast"]}
WALKS = {
    "forward": (0.0, Direction.FORWARD),
    "backward": (0.0, Direction.BACKWARD),
    "turning": (pi / 4, Direction.FORWARD),
}
ANGLES = np.linspace(0.0, tau, DIRECTIONS, endpoint=False)


def largest_shifts(
    plan: ManeuverPlan, time: float, regions: list[Array]
) -> Array:
    """Return the largest recoverable shifts of the DCM by direction, in [m].

    Every smaller shift is recoverable, too.
    """
    dcm = plan.sample([time]).dcm[0]
    found = []
    for angle in ANGLES.tolist():
        heading = np.array([cos(angle), sin(angle)])
        shift = 0.0
        for enter, leave in sorted(
            ray_interval(dcm, heading, region) for region in regions
        ):
            if enter <= shift:
                shift = max(shift, leave)
        found.append(shift)
    return np.array(found)


def ratios(plan: ManeuverPlan, reach: FootReach) -> tuple[Array, Array]:
    """Return recoverable shifts with more and earlier steps, over the bound's.

    Returns:
        Ratios at all times of a step, and at those of its single support.
        Shapes (n, DIRECTIONS), (m, DIRECTIONS).
    """
    many, early = [], []
    end = plan.schedule.first_step_duration
    for time in np.linspace(0.0, end, TIMES, endpoint=False).tolist():
        planned = held_regions(plan, time, reach, 1)
        one = largest_shifts(plan, time, planned)
        one[one <= 0.0] = np.nan
        regions = held_regions(plan, time, reach, FOOTSTEPS)
        many.append(largest_shifts(plan, time, regions) / one)
        phase = next(p for p in plan.support() if p.end > time)
        if phase.single:
            # A landing instead of the next one belongs to a later plan.
            for later in np.linspace(time, phase.end, LANDINGS)[1:-1]:
                planned += held_regions(plan, float(later), reach, 1)[1:]
            early.append(largest_shifts(plan, time, planned) / one)
    return np.array(many), np.array(early)


def main() -> None:
    """Compare the bounds at all times and directions."""
    output = ask(__doc__, "push-steps.json").parse_args().output
    reach = foot_reach()
    along, aside = (np.abs(f(ANGLES)) < 1e-9 for f in (np.sin, np.cos))
    rows = []
    for name, gait in GAITS.items():
        for walk, (bearing, way) in WALKS.items():
            plan = steady_plan(
                ManeuverPlanner(gait), bearing, way, first_foot=Foot.LEFT
            )
            many, early = ratios(plan, reach)
            rows.append(
                {
                    "gait": name,
                    "walk": walk,
                    "more_steps_most": np.nanmax(many) - 1.0,
                    "more_steps_along": np.nanmax(many[:, along]) - 1.0,
                    "more_steps_aside": np.nanmax(many[:, aside]) - 1.0,
                    "earlier_most": np.nanmax(early),
                    "earlier_median": np.nanmedian(early),
                }
            )
    settings = {
        "times": TIMES,
        "directions": DIRECTIONS,
        "landings": LANDINGS,
        "footsteps": FOOTSTEPS,
        "reach_m": reach._asdict(),
    }
    modules = (*PLANNER, "studies/survival_statistics")
    head = header(settings, modules=modules, libraries=("numpy",))
    write_result(output, head, rows=rows)


if __name__ == "__main__":
    main()
