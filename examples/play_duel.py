# /// script
# dependencies = ["stepaside"]
# ///
"""Play a duel of two NAOs in physics, read its arrays, draw its figure.

Run it alone: ``python examples/play_duel.py``; it writes duel.png.
"""

import sys
from pathlib import Path

import numpy as np

from stepaside import StartSettings, draw_run, duel, run_game

seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 40.0
settings = duel(seed=7, duration=seconds, start=StartSettings(distance=0.9))
run = run_game(settings)

print(f"{run.outcome.value}: {run.message}")
print(f"closest approach {run.summary.min_distance_m:.3f} m")
if run.theory is not None:
    radius, distance, angle = run.theory
    print(f"circle of theory: {distance:.3f} m apart, {angle:.0f} deg")
print(
    f"at the end:       {run.distance[-1]:.3f} m apart, "
    f"{run.orientation[-1]:.0f} deg"
)

# One row every 20 ms; arrays that a player lacks are None.
steps = np.diff(run.evader.com[:, :2], axis=0)
print(f"the evader's CoM moved {np.hypot(*steps.T).sum():.2f} m")
assert run.evader.landings is not None
print(f"in {len(run.evader.landings)} footsteps")

draw_run(run, Path("duel.png"))
print("figure: duel.png")
