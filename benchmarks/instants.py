"""Which heading and which point the line of sight refers to, and what of it.

The desired heading is the line of sight less a heading. Taken is that of
the foot that has just landed; tried beside it is the mean of both feet.
Sighted are the torsos; tried beside them are the points 20 mm behind, where
the unicycles of the template are. Writes docs/results/instants.json.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from math import cos, sin
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np
from asking import ask, seeds_of
from gathering import finished, gather

from stepaside.control import ControlScheme
from stepaside.games import Run, run_duel
from stepaside.games.circle import theory_of
from stepaside.games.configuration import plain_settings
from stepaside.games.settings import DuelSettings
from stepaside.poses import wrap_angle
from stepaside.studies.results import header, write_result
from stepaside.world.sight import IdealLineOfSight

DURATION = 90.0  # of a duel, in [s]


class Job(NamedTuple):
    """One duel with one pair of choices.

    Attributes:
        seed: Of the duel.
        heading: "landed foot" or "both feet".
        behind: How far behind the torso the sighted point lies, in [m].
    """

    seed: int
    heading: str
    behind: float


class Behind:
    """True state of a robot whose place is a point behind its torso."""

    def __init__(self, truth: Any, behind: float) -> None:
        """Take the place of a true state."""
        self._truth, self._behind = truth, behind

    @property
    def heading(self) -> float:
        """Heading of the torso, in [rad]."""
        return float(self._truth.heading)

    @property
    def position(self) -> tuple[float, float]:
        """Place of the point, in [m]."""
        x, y = self._truth.position
        theta = self._truth.heading
        return x - self._behind * cos(theta), y - self._behind * sin(theta)


def play(job: Job) -> dict[str, Any]:
    """Radii and distance of one duel, in the process of its own choices."""
    look, replan = IdealLineOfSight._look, ControlScheme._replan

    def look_behind(sight: Any, now: float) -> Any:
        own, other = sight._own, sight._other
        sight._own, sight._other = (
            Behind(own, job.behind),
            Behind(other, job.behind),
        )
        try:
            return look(sight, now)
        finally:
            sight._own, sight._other = own, other

    def replan_from_both(
        scheme: Any, started: float, support: Any, *rest: Any, **more: Any
    ) -> None:
        state, seen = rest
        if job.heading == "both feet":
            feet = scheme.left_foot.theta - scheme.right_foot.theta
            mean = scheme.right_foot.theta + 0.5 * wrap_angle(feet)
            bearing = seen.bearing + wrap_angle(support.theta - mean)
            seen = seen._replace(bearing=wrap_angle(bearing))
        replan(scheme, started, support, state, seen, **more)

    settings = DuelSettings(seed=job.seed, duration=DURATION)
    with (
        patch.object(IdealLineOfSight, "_look", look_behind),
        patch.object(ControlScheme, "_replan", replan_from_both),
    ):
        run = run_duel(settings)
    found = run.summary
    return {
        "heading": job.heading,
        "behind_m": job.behind,
        "seed": job.seed,
        "pursuer_radius_m": found.pursuer.radius_m,
        "evader_radius_m": found.evader.radius_m,
        "distance_m": _distance(run, job.behind),
    }


def _distance(run: Run, behind: float) -> float:
    """Mean distance of the sighted points in the last third, in [m]."""
    last = run.times >= run.times[-1] * 2.0 / 3.0
    points = []
    for track in (run.pursuer, run.evader):
        x, y, theta = track.torso[last].T
        points.append((x - behind * np.cos(theta), y - behind * np.sin(theta)))
    (x, y), (u, v) = points
    return float(np.hypot(u - x, v - y).mean())


def main() -> None:
    """Play every pair of choices with every seed."""
    parser = ask(__doc__, "instants.json")
    parser.add_argument("--seeds", type=seeds_of, default=range(7, 11))
    asked = parser.parse_args()
    settings = DuelSettings(duration=DURATION)
    ahead = settings.gait.zmp_forward
    head = header({"seeds": list(asked.seeds), "duration": DURATION})
    jobs = {
        f"{heading}/{behind}/{seed}": Job(seed, heading, behind)
        for heading in ("landed foot", "both feet")
        for behind in (0.0, ahead)
        for seed in asked.seeds
    }
    rows = list(gather(asked.output, head, jobs, play).values())
    theory = theory_of(settings)
    write_result(
        asked.output,
        head,
        theory={
            "radius_m": theory.radius_evader_m,
            "distance_m": theory.distance_m,
        },
        gait=plain_settings(settings)["gait"],
        rows=rows,
    )
    finished(asked.output)


if __name__ == "__main__":
    main()
