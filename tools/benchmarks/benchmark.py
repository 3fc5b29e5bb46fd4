"""Time planner, MPC and duels in one process.

Both sides of every ratio are timed here, on one core; processor times. Drake's
planner and cameras are skipped if they are not installed (``pip install
.[bench,vision]``)::

    python tools/benchmarks/benchmark.py
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("NUMBA_NUM_THREADS", "1")

from benchmark_options import ask, machine
from duel import measure_camera_duel, measure_duel
from mpc import measure_mpc
from planner import measure_planner
from result_files import header, write_result

LIBRARIES = ("mujoco", "numpy", "drake", "daqp", "numba")


def main() -> None:
    """Measure, write and print the results."""
    asked = ask(__doc__, "benchmark.json")
    asked.add_argument("--duration", type=float, default=60.0)
    arguments = asked.parse_args()
    figures = measure_planner() | measure_mpc()
    figures |= measure_duel(arguments.duration) | measure_camera_duel()
    for suffix in ("", "_with_samples"):
        drake = "drake_zmp_planner_us" if not suffix else f"drake{suffix}_us"
        if drake in figures:
            ours = figures[f"plan_20_steps{suffix}_us"]
            figures[f"drake_over_plan{suffix}"] = figures[drake] / ours
    settings = {"seed": 1, "duration_s": arguments.duration}
    head = header(settings)
    write_result(arguments.output, head, machine=machine(), figures=figures)
    for name, value in figures.items():
        print(f"{name}: {value:.3g}")


if __name__ == "__main__":
    main()
