# %% [markdown]
# # Your first duel
#
# Two NAO humanoids play on an open floor. The pursuer (red) turns towards the
# evader; the evader (blue) walks backwards across the line of sight. You play
# one game, read its result, look at its figure, and change the start.
#
# You need an installed stepaside (`pip install . jupyter` in the repository).
# From a shell, the same game is `stepaside duel --seed 7`.
#
# ## Play
#
# A game is described by settings. All have defaults; the seed chooses the
# initial poses. 60 s of physics take a few seconds.

# %%
from stepaside import duel, run_game

run = run_game(duel(seed=7, duration=60.0))
run

# %% [markdown]
# ## Read the result
#
# A run is a value: settings, outcome, arrays, summary. Lengths are in [m],
# angles in [rad], times in [s].

# %%
summary = run.summary
print(f"closest approach {summary.min_distance_m:.3f} m")
print(f"final distance   {run.distance[-1]:.3f} m")
print(f"samples          {run.times.shape[0]}, every {run.times[1]:.2f} s")
print(f"evader's torso   {run.evader.torso.shape}: x, y, heading")

# %% [markdown]
# ## Look at it

# %%
from IPython.display import Image

from stepaside import draw_run

draw_run(run, "duel.png")
Image("duel.png", width=720)

# %% [markdown]
# Both robots end on a circle, a quarter turn apart. For equal speeds $v$ and
# gains $k$ its radius is $4v/(\pi k)$ and the distance between the robots
# $4\sqrt{2}\,v/(\pi k)$:

# %%
from math import pi, sqrt

v, k = 0.1, 0.2  # speed in [m/s], gain in [1/s]
radius = 4.0 * v / (pi * k)
print(f"radius {radius:.3f} m, distance {sqrt(2.0) * radius:.3f} m")

# %% [markdown]
# ## Change the start
#
# The pursuer begins 0.7 m away and turned by 60° from the line of sight.

# %%
from math import radians

from stepaside import StartSettings

close = run_game(
    duel(
        duration=60.0,
        start=StartSettings(0.7, radians(60.0), 0.0),
    )
)
import matplotlib.pyplot as plt

plt.figure(figsize=(7, 3))
for name, game in (("seed 7", run), ("from 0.7 m", close)):
    plt.plot(game.times, game.distance, label=name)
plt.axhline(0.9, color="0.6", ls=":", label="theory")
plt.xlabel("time [s]")
plt.ylabel("distance [m]")
plt.legend()
# %% [markdown]
# ## Keep it
#
# `write_run` makes a folder with everything that is needed to play the game
# again, bit by bit; `stepaside show FOLDER` shows it in the browser.

# %%
from pathlib import Path

from stepaside import write_run

write_run(Path("kept"), close)
sorted(file.name for file in Path("kept").iterdir())

# %% [markdown]
# Next: [your own evader](own_evader), or every option of the command in the
# [reference](../commands).
