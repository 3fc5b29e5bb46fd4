# /// script
# dependencies = ["stepaside"]
# ///
"""Games of two unicycles: circle, certificate and two thousand starts.

Run it alone: ``python examples/unicycle_games.py``.
"""

from math import degrees, pi
from time import perf_counter

import numpy as np

from stepaside import (
    RelativeStart,
    Unicycles,
    certify,
    find_circle,
    play_games,
    simulate,
)

game = Unicycles(0.1, 0.1, 0.2, 0.2)  # speeds [m/s], gains [1/s]

circle = find_circle(0.1, 0.1, 0.2, 0.2)
print(
    f"circle: radius {circle.radius_evader_m:.3f} m, players "
    f"{circle.distance_m:.3f} m and "
    f"{degrees(circle.headings_apart_rad):.0f} deg apart"
)

start = RelativeStart(1.0, 0.3, 0.4)  # distance [m], both bearings [rad]
certified = certify(game, start)
run = simulate(game, start, 60.0)
assert certified is not None
print(f"certified closest approach {certified:.3f} m,")
print(f"played                     {run.closest_distance:.3f} m")

draw = np.random.default_rng(1)
starts = np.column_stack(
    [
        draw.uniform(0.6, 1.5, 2_000),
        draw.uniform(-pi / 2, pi / 2, 2_000),
        draw.uniform(-pi / 6, pi / 6, 2_000),
    ]
)
began = perf_counter()
outcomes = play_games(game, starts, 60.0)
took = perf_counter() - began
print(
    f"{len(starts)} games of 60 s in {took:.1f} s: closest approach "
    f"{outcomes.closest_distance.min():.3f} m"
)
