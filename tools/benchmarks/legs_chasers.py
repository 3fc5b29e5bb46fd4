r"""Let a person who steers at it chase a robot on learned legs.

The robot is a matador. Four directions for each turning radius, 40 s each::

    python tools/benchmarks/legs_chasers.py runs/g1 runs/g1.onnx
"""

from dataclasses import replace
from math import pi, tau
from pathlib import Path
from typing import Any

from benchmark_options import ask
from tqdm import tqdm

from stepaside.core.worker_pool import worker_pool
from stepaside.games.duel import run_duel
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.robot_settings import with_legs, with_robot
from stepaside.locomotion.policy.legs_loader import load_legs
from stepaside.locomotion.policy.legs_settings import LegsSettings
from stepaside.robots.description import load_robot
from stepaside.sim.person_settings import PersonSettings
from stepaside.studies.code_version import PHYSICS
from stepaside.studies.result_files import header, write_result
from stepaside.theory.chauffeur.chauffeur_game import guaranteed_distance

RADII = (2.5, 4.0, 8.0)  # of the turns of the person, in [m]
DIRECTIONS = 4
SPEED = 1.4  # of the person, in [m/s]
STEERING = 10.0  # gain of the person, in [1/s]: it turns at its limit
DISTANCE = 8.0  # at first, in [m]
DURATION = 40.0  # of a duel, in [s]


def chase(settings: DuelSettings) -> dict[str, Any]:
    """Return how one chase ended."""
    run = run_duel(settings)
    return {
        "turning_radius_m": settings.person.turning_radius,
        "outcome": run.outcome.value,
        "duration_s": run.duration,
        "closest_m": run.summary.min_distance_m,
        "template_closest_m": run.summary.theory.closest_approach_m,
    }


def main() -> None:
    """Play and write the results."""
    parser = ask(__doc__, "legs-chasers.json")
    parser.add_argument("robot", type=Path)
    parser.add_argument("network", type=Path)
    parser.add_argument("--workers", type=int, default=1)
    asked = parser.parse_args()
    head = header(
        {
            "speed_m_s": SPEED,
            "directions": DIRECTIONS,
            "duration_s": DURATION,
            "strategy": "matador",
        },
        modules=PHYSICS,
    )
    network = str(asked.network)
    settings = replace(
        with_legs(with_robot(DuelSettings(), str(asked.robot)), network),
        duration=DURATION,
        pursuer="person",
        evader_strategy="matador",
    )
    games = [
        replace(
            settings,
            person=PersonSettings(
                "steer", SPEED, STEERING, turning_radius=radius
            ),
            start=replace(
                settings.start,
                distance=DISTANCE,
                pursuer_offset=0.0,
                evader_offset=pi - tau * i / DIRECTIONS,
            ),
        )
        for radius in RADII
        for i in range(DIRECTIONS)
    ]
    legs = load_legs(LegsSettings(network), load_robot(asked.robot), tick=0.02)
    walks = legs.velocities.forward[1]
    with worker_pool(asked.workers) as pool:
        rows = list(
            tqdm(pool.map(chase, games), total=len(games), disable=None)
        )
    write_result(
        asked.output,
        head,
        forward_m_s=walks,
        closed_form_m={
            f"{radius:g}": radius * guaranteed_distance(walks / SPEED)
            for radius in RADII
        },
        chases=rows,
    )


if __name__ == "__main__":
    main()
