"""Compare definitions of the heading and the point of the line of sight.

The desired heading is the direction of the line of sight minus a heading: that
of the path at the time of the sighting (used), that of the foot that landed
last, or the mean of both feet. The sighted point is the midpoint between the
feet (used) or the torso. Writes docs/results/sight-definitions.json.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np
from benchmark_options import ask, seeds_of
from resumable_jobs import finished, gather

from stepaside.control import ControlScheme
from stepaside.core.poses import wrap_angle
from stepaside.games import DuelRun, run_duel
from stepaside.games.configuration_file import settings_entries
from stepaside.games.duel_circle import circle_of_theory
from stepaside.games.duel_settings import DuelSettings
from stepaside.sim.ideal_sensors import IdealLineOfSight
from stepaside.studies.result_files import header, write_result

DURATION = 120.0  # duration of a duel, in [s]
CHOICES = (  # heading that is subtracted, point that is sighted
    ("path", "place"),
    ("both feet", "place"),
    ("landed foot", "place"),
    ("path", "torso"),
    ("landed foot", "torso"),
)


class Job(NamedTuple):
    """Duel with one combination of definitions.

    Attributes:
        seed: Random seed of the duel.
        heading: "path", "landed foot" or "both feet".
        point: "place" or "torso".
    """

    seed: int
    heading: str
    point: str


class Torso:
    """True state of a robot whose reference point is its torso."""

    def __init__(self, truth: Any) -> None:
        """Wrap a true state."""
        self._truth = truth

    @property
    def heading(self) -> float:
        """Heading of the torso in the world frame, in [rad]."""
        return float(self._truth.heading)

    @property
    def place(self) -> tuple[float, float]:
        """Position of the torso in the world frame, in [m]."""
        x, y = self._truth.position
        return x, y


def play(job: Job) -> dict[str, Any]:
    """Return radii and distance of one duel; run in a process of its own."""
    look, decide = IdealLineOfSight._measure, ControlScheme.decide

    def look_at_torsos(sight: Any, now: float) -> Any:
        own, other = sight._own, sight._other
        sight._own, sight._other = Torso(own), Torso(other)
        try:
            return look(sight, now)
        finally:
            sight._own, sight._other = own, other

    def decide_from_feet(
        scheme: Any, now: float, support: Any, side: Any, *, moving: bool
    ) -> Any:
        walk, seen = scheme.state, scheme.sighting
        subtracted = support.theta
        if job.heading == "both feet":
            feet = walk.left_foot.theta - walk.right_foot.theta
            subtracted = walk.right_foot.theta + 0.5 * wrap_angle(feet)
        path = scheme.decisions.templates.at(seen.time).theta
        bearing = wrap_angle(seen.bearing + path - subtracted)
        scheme.sighting = seen._replace(bearing=bearing)
        try:
            return decide(scheme, now, support, side, moving=moving)
        finally:
            scheme.sighting = seen

    settings = DuelSettings(seed=job.seed, duration=DURATION)
    by_path, at_place = job.heading == "path", job.point == "place"
    with (
        patch.object(
            IdealLineOfSight, "_measure", look if at_place else look_at_torsos
        ),
        patch.object(
            ControlScheme, "decide", decide if by_path else decide_from_feet
        ),
    ):
        run = run_duel(settings)
    found = run.summary
    return {
        "heading": job.heading,
        "point": job.point,
        "seed": job.seed,
        "pursuer_radius_m": found.pursuer.radius_m,
        "evader_radius_m": found.evader.radius_m,
        "distance_m": found.distance_m,
        "torsos_apart_m": _between_torsos(run),
    }


def _between_torsos(run: DuelRun) -> float:
    """Return the mean distance of the torsos in the last third, in [m]."""
    last = run.times >= run.times[-1] * 2.0 / 3.0
    apart = run.pursuer.torso[last] - run.evader.torso[last]
    return float(np.hypot(apart[:, 0], apart[:, 1]).mean())


def main() -> None:
    """Run every combination with every seed."""
    parser = ask(__doc__, "sight-definitions.json")
    parser.add_argument("--seeds", type=seeds_of, default=range(7, 11))
    asked = parser.parse_args()
    settings = DuelSettings(duration=DURATION)
    head = header({"seeds": list(asked.seeds), "duration": DURATION})
    jobs = {
        f"{heading}/{point}/{seed}": Job(seed, heading, point)
        for heading, point in CHOICES
        for seed in asked.seeds
    }
    rows = list(gather(asked.output, head, jobs, play).values())
    theory = circle_of_theory(settings)
    write_result(
        asked.output,
        head,
        theory={
            "radius_m": theory.radius_evader_m,
            "distance_m": theory.distance_m,
        },
        gait=settings_entries(settings)["gait"],
        rows=rows,
    )
    finished(asked.output)


if __name__ == "__main__":
    main()
