r"""Measure a walking policy: tracking, random commands, duels on its circle.

Walks the commands of ``stepaside robot legs measure`` and ten minutes of
random commands, writes the response beside the robot, and plays duels::

    stepaside robot init g1_12dof.urdf --output runs/g1_12
    uv run tools/export_policy.py motion.pt --convention legged_gym \
        --output runs/g1_12dof.onnx
    python tools/benchmarks/learned_legs.py runs/g1_12 runs/g1_12dof.onnx
"""

from argparse import Namespace
from dataclasses import replace
from math import isfinite
from pathlib import Path
from typing import Any

import tomli_w
from benchmark_options import ask, seeds_of
from tqdm import tqdm

from stepaside.cli.legs_measure import measurement_facts
from stepaside.core.atomic_output import atomic_draft
from stepaside.core.worker_pool import worker_pool
from stepaside.fitting.legs_measurement import measure_legs
from stepaside.games.duel_circle import circle_of_theory
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.recorded_game import run_duel
from stepaside.games.robot_settings import (
    LEGS_GAIT,
    with_legs,
    with_robot,
)
from stepaside.games.run_archive import results_of
from stepaside.locomotion.control_settings import LegsSettings
from stepaside.locomotion.policy.velocity_response import (
    response_entries,
    response_path,
)
from stepaside.robots.description import load_robot
from stepaside.sim.body_settings import BODIES
from stepaside.studies.result_files import header, write_result

DURATION = 120.0  # of a duel, in [s]


def duel_row(settings: DuelSettings) -> dict[str, Any]:
    """Return what the documents show of a duel, relative to theory."""
    summary = results_of(run_duel(settings))
    angle = summary["relative_orientation_deg"]
    circle = circle_of_theory(settings)

    def ratio(value: float | None, expected: float) -> float | None:
        return None if value is None else value / expected

    return {
        "outcome": summary["outcome"],
        "duration_s": summary["duration_s"],
        "distance_ratio": ratio(summary["distance_m"], circle.distance_m),
        "pursuer_ratio": ratio(
            summary["players"]["pursuer"]["radius_m"], circle.radius_pursuer_m
        ),
        "evader_ratio": ratio(
            summary["players"]["evader"]["radius_m"], circle.radius_evader_m
        ),
        "angle_deg": None if not isfinite(angle or 0.0) else angle,
        "converged_at_s": summary["converged_at_s"],
    }


def main() -> None:
    """Measure, play, and write the results."""

    def name_of(given: Namespace) -> str:
        return f"legs-{given.network.stem}.json"

    parser = ask(__doc__, name_of)
    parser.add_argument("robot", type=Path)
    parser.add_argument("network", type=Path)
    parser.add_argument("--legs-contract", default="")
    parser.add_argument("--speed", type=float, default=LEGS_GAIT["speed"])
    parser.add_argument("--seeds", type=seeds_of, default=range(1, 11))
    parser.add_argument("--random-walks", type=int, default=10)
    parser.add_argument("--workers", type=int, default=1)
    asked = parser.parse_args()
    head = header(
        {
            "seeds": [asked.seeds.start, asked.seeds.stop],
            "duel_s": DURATION,
            "speed_m_s": asked.speed,
        }
    )
    description, legs = (
        load_robot(asked.robot),
        LegsSettings(str(asked.network), asked.legs_contract),
    )
    with worker_pool(asked.workers) as pool, tqdm(disable=None) as bar:

        def report(done: int, total: int) -> None:
            bar.n, bar.total = done, total
            bar.refresh()

        found = measure_legs(
            description,
            legs,
            BODIES["ideal"],
            pool,
            report,
            random_walks=asked.random_walks,
        )
        file = response_path(description.folder, asked.network)
        with atomic_draft(file) as draft:
            entries = response_entries(found.response, asked.network)
            draft.write_text(tomli_w.dumps(entries), encoding="utf-8")
        settings = with_legs(
            with_robot(DuelSettings(), str(asked.robot)), legs.network
        )
        settings = replace(
            settings,
            duration=DURATION,
            legs=legs,
            gait=replace(
                settings.gait,
                speed=asked.speed,
                stride=asked.speed * settings.gait.step_duration,
            ),
        )
        games = [replace(settings, seed=seed) for seed in asked.seeds]
        rows = {}
        for seed, row in zip(
            asked.seeds, pool.map(duel_row, games), strict=True
        ):
            rows[str(seed)] = row
            report(len(rows), len(games))
    facts = measurement_facts(found)
    write_result(asked.output, head, measured=facts, duels=rows)


if __name__ == "__main__":
    main()
