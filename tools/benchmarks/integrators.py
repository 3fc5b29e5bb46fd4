r"""Compare integrators and time steps of the physics with a 1 ms reference.

The same walks are simulated with each: on an ideal body in open loop, with
feedback after a push and on a slope, and on the hardware body on a level and
an uneven floor. Every seed draws its own bearing, push and floor. A variant
is as accurate as the default if its differences from the reference are not
larger than those of the default::

    python tools/benchmarks/integrators.py --seeds 1:101 --workers 1 \
        --variants implicitfast-2ms discrete-4ms
"""

from dataclasses import replace
from math import pi
from time import process_time
from typing import Any, NamedTuple

import numpy as np
from benchmark_options import ask, seeds_of
from resumable_jobs import Row, finished, gather

from stepaside.core.random_streams import named_generator
from stepaside.games.walk_game import run_walk
from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.zmp.control_settings import STABILISED
from stepaside.sim.body_settings import BODIES
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.sim.push import Push
from stepaside.studies.result_files import header, write_result

DURATION = 10.0  # of a walk, in [s]
EARLY = 3.0  # time of the first comparison of positions, in [s]
REFERENCE = ("implicitfast", 0.001)
DEFAULT = ("implicitfast", 0.002)
VARIANTS = (
    REFERENCE,
    ("discrete", 0.001),
    DEFAULT,
    ("implicitfast", 0.004),
    ("discrete", 0.002),
    ("discrete", 0.004),
)
CASES = ("ideal", "pushed", "slope", "hardware", "uneven")
COMPARED = ("early_m", "final_m", "turn_rad", "speed_ratio", "slip_per_step_m")


class IntegratorTrial(NamedTuple):
    """Walk with one integrator.

    Attributes:
        case: One of ``CASES``.
        integrator: Integrator of MuJoCo.
        time_step: Its time step, in [s].
        seed: Seed of bearing, push, floor and body.
    """

    case: str
    integrator: str
    time_step: float
    seed: int


def settings_of(trial: IntegratorTrial) -> WalkSettings:
    """Return the walk of a trial."""
    draws = named_generator(trial.seed, "integrators")
    bearing, direction = draws.uniform((-0.5, -pi), (0.5, pi)).tolist()
    physics = PhysicsSettings(
        integrator=trial.integrator, time_step=trial.time_step
    )
    walk = WalkSettings(
        seed=trial.seed, bearing=bearing, duration=DURATION, physics=physics
    )
    if trial.case == "ideal":
        return walk
    walk = replace(walk, control=STABILISED)
    if trial.case == "pushed":
        push = Push(2.0, 4.0 + trial.seed % 7 / 10.0, direction)
        return replace(walk, pushes=(push,))
    if trial.case == "slope":
        sloped = replace(physics, slope=0.03, slope_direction=direction)
        return replace(walk, physics=sloped)
    walk = replace(walk, body=BODIES["hardware"])
    if trial.case == "uneven":
        walk = replace(walk, physics=replace(physics, unevenness=0.004))
    return walk


def play(trial: IntegratorTrial) -> Row:
    """Return the values of one walk."""
    began = process_time()
    run = run_walk(settings_of(trial))
    spent = process_time() - began
    track, summary = run.tracks["walker"], run.summary
    early = int(np.searchsorted(run.times, EARLY - 1e-9))
    return {
        "outcome": run.outcome.value,
        "processor_s": spent,
        "early": track.com[min(early, len(track.com) - 1), :2].tolist(),
        "final": track.com[-1, :2].tolist(),
        "turn_rad": float(track.torso[-1, 2]),
        "speed_ratio": summary.speed_ratio,
        "slip_per_step_m": summary.slip_per_step_m,
    }


def differences(row: Row, reference: Row) -> dict[str, float | None]:
    """Return the absolute differences of a walk from its reference."""
    found: dict[str, float | None] = {
        f"{at}_m": float(np.hypot(*np.subtract(row[at], reference[at])))
        for at in ("early", "final")
    }
    for key in ("turn_rad", "speed_ratio", "slip_per_step_m"):
        one, other = row[key], reference[key]
        found[key] = None if None in (one, other) else abs(one - other)
    return found


def compare(
    rows: dict[str, Row], case: str, variant: tuple[str, float], seeds: range
) -> dict[str, Any]:
    """Return means over the seeds of one case, and the falls.

    Walks that fall with either integrator count as falls only.
    """
    found, falls, reference_falls = [], 0, 0
    spent = 0.0
    for seed in seeds:
        row = rows[name_of(case, variant, seed)]
        reference = rows[name_of(case, REFERENCE, seed)]
        fell = [r["outcome"] != "completed" for r in (row, reference)]
        falls, reference_falls = falls + fell[0], reference_falls + fell[1]
        spent += row["processor_s"]
        if not any(fell):
            found.append(differences(row, reference))
    means = {}
    for key in COMPARED:
        values = [d[key] for d in found if d[key] is not None]
        means[key] = float(np.mean(np.array(values))) if values else None
    return {
        "falls": falls,
        "falls_of_reference": reference_falls,
        "processor_s": spent / len(seeds),
        **means,
    }


def name_of(case: str, variant: tuple[str, float], seed: int) -> str:
    """Return the name of a job."""
    return f"{case}/{label_of(variant)}/{seed}"


def label_of(variant: tuple[str, float]) -> str:
    """Return the name of an integrator and its time step."""
    integrator, time_step = variant
    return f"{integrator}-{1e3 * time_step:g}ms"


def main() -> None:
    """Simulate the walks, compare, and write the results."""
    asked = ask(__doc__, "integrators.json")
    asked.add_argument("--seeds", type=seeds_of, default="1:11")
    asked.add_argument("--workers", type=int)
    labels = [label_of(variant) for variant in VARIANTS]
    asked.add_argument("--variants", nargs="+", choices=labels, default=labels)
    arguments = asked.parse_args()
    seeds: range = arguments.seeds
    variants = [
        variant
        for variant in VARIANTS
        if variant == REFERENCE or label_of(variant) in arguments.variants
    ]
    head = header({"seeds": [seeds.start, seeds.stop], "duration_s": DURATION})
    jobs = {
        name_of(case, variant, seed): IntegratorTrial(case, *variant, seed)
        for seed in seeds
        for case in CASES
        for variant in variants
    }
    rows = gather(arguments.output, head, jobs, play, arguments.workers)
    cases = {
        case: {
            label_of(variant): compare(rows, case, variant, seeds)
            for variant in variants
        }
        for case in CASES
    }
    write_result(arguments.output, head, number=len(seeds), cases=cases)
    finished(arguments.output)


if __name__ == "__main__":
    main()
