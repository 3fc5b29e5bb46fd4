# /// script
# dependencies = ["stepaside"]
# ///
"""Write a run to a folder, load it again, and write its offline page.

Run it alone: ``python examples/keep_runs.py``; it writes run/ and run.html.
"""

import sys
from pathlib import Path

import numpy as np

from stepaside import duel, load_run, run_game, write_page, write_run

seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 20.0
folder, page = Path("run"), Path("run.html")

if not folder.exists():
    write_run(folder, run_game(duel(seed=3, duration=seconds)))
run = load_run(folder, "duel")

print(
    f"{folder} holds {run.name}, {run.duration:.1f} s, seed "
    f"{run.settings.seed}"
)
for name, track in run.tracks.items():
    x, y, heading = track.torso[-1]
    print(f"{name:<8} ends at ({x:6.3f}, {y:6.3f}) m, {heading:6.3f} rad")
speed = np.gradient(run.distance, run.times)
print(f"fastest approach {-speed.min():.3f} m/s")

write_page(run, page)
print(f"{page}: {page.stat().st_size / 1e6:.1f} MB, opens without a network")
