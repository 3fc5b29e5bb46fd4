"""Time a decision among the polygons of a sensed map.

Occupied cells of a map of a 3 x 3 m room with discs, as a depth camera leaves
them, are covered by convex polygons; more discs make more polygons. Measured
is the processor time of each part of a decision, at a new position and with
a cold cache each time::

    python tools/benchmarks/map_decisions.py
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from collections.abc import Callable
from functools import partial
from math import atan2, hypot
from time import process_time
from typing import Any

import numpy as np
from benchmark_options import ask, machine

from stepaside.arena import (
    ObstacleSet,
    Room,
    RoomRecipe,
    draw_initial_poses,
    generate_room,
)
from stepaside.control.clearance.guard import Guard
from stepaside.control.clearance.surroundings import Surroundings
from stepaside.control.clearance.swept_outline import lateral_sway
from stepaside.core.poses import Pose, wrap_angle
from stepaside.locomotion.maneuver_selection import GuardDecision
from stepaside.perception.floor_map import cover
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
    TemplateDrive,
)
from stepaside.robots.description import load_robot
from stepaside.sim.outline_measurement import measure_outline
from stepaside.strategies import (
    Intent,
    Knowledge,
    Limits,
    LookAhead,
    Pursuit,
    Strategy,
)
from stepaside.studies.result_files import header, write_result

GAIT = GaitSettings()
NAO = measure_outline(load_robot("nao"), GAIT)
PLANNER = ManeuverPlanner(GAIT)
MARGIN, CELL = 0.02, 0.05  # margins of the guard and of a map, in [m]
NEEDS = NAO.radius + MARGIN + lateral_sway(GAIT)
MODULES = ("planning", "arena", "strategies", "control/clearance")
RECIPES = (RoomRecipe(), RoomRecipe(discs=3), RoomRecipe(discs=6))
WIDE = 2.0  # half side of a map, in [m]


class Taken(Surroundings):
    """Fixed surroundings from a map."""

    map_error = CELL

    def __init__(self, solids: ObstacleSet) -> None:
        """Store the obstacles."""
        self.solids = solids


def seen(room: Room, fine: float) -> ObstacleSet:
    """Return polygons that cover all map cells within 10 cm of a surface."""
    ticks = np.arange(-WIDE, WIDE, CELL) + 0.5 * CELL
    cells = np.stack(np.meshgrid(ticks, ticks), axis=-1).reshape(-1, 2)
    clear = room.clearance(cells)
    return ObstacleSet(
        cover(cells[(clear < 0.0) & (clear > -0.1)], CELL, fine)
    )


def knowledge(
    starts: tuple[Pose, Pose], own: int, solids: ObstacleSet
) -> Knowledge:
    """Return the knowledge of one of two players at its initial pose."""
    here, other = starts[own], starts[1 - own]
    x, y = other.x - here.x, other.y - here.y
    limits = Limits(GAIT.speed, GAIT.gain, GAIT.stride, GAIT.step_duration)
    bearing = wrap_angle(atan2(y, x) - here.theta)
    return Knowledge(
        0.0,
        bearing,
        hypot(x, y),
        limits,
        pose_in_map=here,
        obstacles_in_map=solids,
    )


def guarded(pose: Pose, solids: ObstacleSet) -> Callable[[], object]:
    """Evaluate the guard once at a position."""
    guard = Guard(Taken(solids), NAO, PLANNER, margin=MARGIN)
    half = 0.5 * GAIT.foot_spacing
    support = pose.compose(Pose(0.0, -half, 0.0))
    state = CenterState((0.01, 0.025), (-0.07, -0.04))

    def plan_for(choice: GuardDecision) -> ManeuverPlan:
        return PLANNER.plan(
            choice.intent.heading,
            Direction.BACKWARD,
            first_foot=Foot.LEFT,
            state=state,
            drive=TemplateDrive(speed_factor=choice.intent.speed_factor),
        )

    return lambda: guard.choose(Intent(0.4), plan_for, support, standing=False)


def decide(mind: Strategy, known: Knowledge) -> object:
    """Evaluate the first decision of a strategy."""
    return mind.decide(known, mind.begin())


def timed(do: Callable[[], object]) -> float:
    """Return the processor time of one call, in [s]."""
    begun = process_time()
    do()
    return process_time() - begun


def measure(recipe: RoomRecipe, fine: float, games: int) -> dict[str, Any]:
    """Return the times of the parts of decisions in rooms with new maps."""
    evader, pursuer = LookAhead(body_radius=NEEDS), Pursuit(body_radius=NEEDS)
    times: dict[str, list[float]] = {}
    counts: list[int] = []
    for seed in range(games):
        room = generate_room(recipe, seed)
        starts = draw_initial_poses(room, seed, NEEDS)
        solids = seen(room, fine)
        counts.append(len(solids.shapes))
        for own, name, mind in (
            (1, "look-ahead", evader),
            (0, "pursuit", pursuer),
        ):
            known = knowledge(starts, own, solids)
            spent = timed(partial(decide, mind, known))
            times.setdefault(name, []).append(spent)
        times.setdefault("guard", []).append(timed(guarded(starts[1], solids)))
    return {
        "polygons": [min(counts), max(counts)],
        "decisions": games,
        **{
            name: {
                "median_ms": 1e3 * float(np.median(each[1:])),
                "p99_ms": 1e3 * float(np.percentile(each[1:], 99.0)),
                "longest_ms": 1e3 * max(each[1:]),
            }
            for name, each in times.items()
        },
    }


def main() -> None:
    """Measure and write the results."""
    asked = ask(__doc__, "map-decisions.json")
    asked.add_argument("--games", type=int, default=40)
    arguments = asked.parse_args()
    head = header({"games": arguments.games})
    measure(RECIPES[0], 2.2, 2)  # import all code
    rows = [
        measure(recipe, fine, arguments.games)
        for recipe, fine in zip(RECIPES, (2.2, 1.25, 1.15), strict=True)
    ]
    write_result(arguments.output, head, machine=machine(), rows=rows)


if __name__ == "__main__":
    main()
