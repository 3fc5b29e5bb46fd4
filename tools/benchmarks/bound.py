"""Time the bound solver against ``hj_reachability``, on one core.

Both solve the same game on the same grid with the same scheme and horizon in
one process: fifth-order slopes, local Lax-Friedrichs flux, third-order
Runge-Kutta steps. Both are compiled before they are timed; the best of three
runs of ours counts::

    pip install "stepaside[fast]" hj_reachability
    python tools/benchmarks/bound.py
"""

import os

os.environ["NUMBA_NUM_THREADS"] = "1"
os.environ["XLA_FLAGS"] = (
    "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
)

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from benchmark_options import ask, machine
from numpy.typing import NDArray

from stepaside.studies.result_files import header, write_result
from stepaside.theory.bound import (
    DiscretisationScheme,
    Grid,
    fixed_pursuit_game,
    solve_bound,
)
from stepaside.theory.bound.relative_game import BoundGame

MODULES = ("theory/bound", "theory/unicycle")
Array = NDArray[np.float64]
ACCURACY = {
    DiscretisationScheme.LAX: "very_high",
    DiscretisationScheme.FIRST_LAX: "low",
}
WITHIN = 5e-4  # differences below this count as zero, in [m]
LIBRARIES = ("numpy", "numba", "jax", "hj_reachability")


def reference_solver(
    game: BoundGame, grid: Grid, accuracy: str
) -> Callable[[float], Array]:
    """Return a solver by ``hj_reachability``, a function of the horizon."""
    import hj_reachability as hj
    import jax
    import jax.numpy as jnp

    class Relative(
        hj.ControlAndDisturbanceAffineDynamics  # type: ignore[misc]
    ):
        """Relative dynamics of two unicycles: distance and bearings."""

        def __init__(self) -> None:
            limits = [game.evader_turn, game.pursuer_turn]
            boxes = [
                hj.sets.Box(jnp.array([-turn]), jnp.array([turn]))
                for turn in limits
            ]
            super().__init__("max", "min", *boxes)

        def open_loop_dynamics(self, state: Any, time: Any) -> Any:
            """Rates of the state without turning inputs."""
            r, a, psi = state
            vp, ve = game.pursuer_speed, game.evader_speed
            swing = (vp * jnp.sin(a) - ve * jnp.sin(psi)) / r
            closing = ve * jnp.cos(psi) - vp * jnp.cos(a)
            law = game.pursuer_gain * a
            return jnp.array([closing, swing - law, swing])

        def control_jacobian(self, state: Any, time: Any) -> Any:
            """Effect of the evader's turning rate."""
            return jnp.array([[0.0], [0.0], [-1.0]])

        def disturbance_jacobian(self, state: Any, time: Any) -> Any:
            """Effect of the pursuer's turning rate."""
            return jnp.array([[0.0], [-1.0], [0.0]])

    def ended(x: Any, width: int) -> Any:
        """Boundary values: terminal below, extrapolation above."""
        low = jnp.full(width, x[0])
        high = x[-1] + (x[-1] - x[-2]) * jnp.arange(1, width + 1)
        return jnp.concatenate([low, x, high])

    _, step_a, step_psi = grid.spacings
    low = np.array([grid.near, step_a / 2 - np.pi, step_psi / 2 - np.pi])
    high = np.array([grid.far, *(low[1:] + 2.0 * np.pi)])
    periodic = hj.boundary_conditions.periodic
    lattice = hj.Grid.from_lattice_parameters_and_boundary_conditions(
        hj.sets.Box(low, high),
        (grid.distances, grid.errors, grid.bearings),
        boundary_conditions=(ended, periodic, periodic),
    )
    distance = lattice.states[..., 0]
    settings = hj.SolverSettings.with_accuracy(
        accuracy,
        artificial_dissipation_scheme=(
            hj.artificial_dissipation.local_lax_friedrichs
        ),
        value_postprocessor=lambda t, v: jnp.clip(
            jnp.minimum(v, distance), grid.near, None
        ),
    )
    dynamics = Relative()

    def solve(horizon: float) -> Array:
        found = hj.step(
            settings, dynamics, lattice, 0.0, distance, -horizon,
            progress_bar=False,
        )  # fmt: skip
        whole = np.asarray(jax.block_until_ready(found))
        return np.moveaxis(whole, 0, 1)[grid.errors // 2 :]

    return solve


def use_one_core() -> None:
    """Pin this process to one core, if the system supports it."""
    if hasattr(os, "sched_setaffinity"):
        core = max(os.sched_getaffinity(0))
        os.sched_setaffinity(0, {core})


def measure(
    cells: int, horizon: float, scheme: DiscretisationScheme, *, double: bool
) -> dict[str, Any]:
    """Return both times, their ratio, and the difference of the values."""
    import jax

    jax.config.update("jax_enable_x64", double)
    game = fixed_pursuit_game(1.0, 1.0, 1.0)
    grid = Grid.cube(0.3, 4.0, cells)
    reference = reference_solver(game, grid, ACCURACY[scheme])
    reference(0.01 * horizon)  # compile
    begin = time.process_time()
    values = reference(horizon)
    slow = time.process_time() - begin

    fast = np.inf
    for duration in (0.01 * horizon, *[horizon] * 3):
        begin = time.process_time()
        bound = solve_bound(
            game, grid, horizon=duration, scheme=scheme, double=double
        )
        if duration == horizon:
            fast = min(fast, time.process_time() - begin)
    apart = np.abs(values - bound.values)
    return {
        "scheme": scheme.value,
        "double": double,
        "cells": cells,
        "horizon": horizon,
        "bound_s": fast,
        "hj_reachability_s": slow,
        "ratio": slow / fast,
        "greatest_difference": float(apart.max()),
        "mean_difference": float(apart.mean()),
        "share_within": float((apart <= WITHIN).mean()),
    }


def main() -> None:
    """Measure, write and print the results."""
    asked = ask(__doc__, "bound-speed.json")
    asked.add_argument("--cells", type=int, default=64)
    asked.add_argument("--horizon", type=float, default=3.0)
    arguments = asked.parse_args()
    try:
        import hj_reachability  # noqa: F401
    except ImportError:
        raise SystemExit("hj_reachability is not installed") from None
    use_one_core()
    cells, horizon = arguments.cells, arguments.horizon
    rows = [
        measure(cells, horizon, DiscretisationScheme.LAX, double=True),
        measure(cells, horizon, DiscretisationScheme.FIRST_LAX, double=False),
        measure(cells, horizon, DiscretisationScheme.LAX, double=False),
    ]
    settings = {"cells": cells, "horizon": horizon, "within": WITHIN}
    head = header(settings, modules=MODULES, libraries=LIBRARIES)
    write_result(arguments.output, head, machine=machine(), rows=rows)
    for row in rows:
        print(
            *(
                f"{name} {value:.3g}" if isinstance(value, float) else value
                for name, value in row.items()
            )
        )


if __name__ == "__main__":
    main()
