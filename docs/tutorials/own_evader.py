# %% [markdown]
# # Your own evader in 15 lines
#
# A strategy is a function: what a player knows goes in, what it wants comes
# out. You write one, play it with unicycles in milliseconds, and then on
# humanoids in physics.
#
# `Knowledge` holds the bearing and distance of the other player, in the frame
# of the player's own pose. `Intent` asks for a heading relative to the
# player's own. The paper's evader turns its back across the line of sight, at
# an angle of 90°. Yours moves straight back while the pursuer is near, and
# across while it is far.

# %%
from dataclasses import dataclass, replace
from math import pi

from stepaside import Evasion


@dataclass(frozen=True)
class BackAndAside(Evasion):
    """Blends "move back" into "move aside" as the distance grows."""

    def decide(self, knowledge, memory):
        share = min(max(2.0 * knowledge.distance - 1.0, 0.0), 1.0)
        evader = replace(self, angle=0.5 * pi * share)
        return Evasion.decide(evader, knowledge, memory)


# %% [markdown]
# ## With unicycles
#
# The same duel without legs: both players are unicycles that decide once per
# step, every 0.55 s. A game of one minute takes milliseconds.

# %%
from stepaside import StartSettings, duel, run_game

settings = duel(duration=60.0, start=StartSettings(0.7, -0.3, 0.2))
for name, evader in {"paper": Evasion(), "own": BackAndAside()}.items():
    steps = settings.changed(level="steps")
    game = run_game(steps, strategies={"evader": evader})
    print(f"{name}: closest approach {game.distance.min():.3f} m")

# %% [markdown]
# ## With humanoids
#
# The same settings with the level that they have by default.

# %%
own = run_game(settings, strategies={"evader": BackAndAside()})
print(f"closest approach {own.summary.min_distance_m:.3f} m")

# %%
import matplotlib.pyplot as plt

figure, axes = plt.subplots(figsize=(6, 4))
axes.plot(*own.pursuer.torso[:, :2].T, color="#b92b19", label="pursuer")
axes.plot(*own.evader.torso[:, :2].T, color="#1f5fbf", label="evader")
for track, marker in ((own.pursuer, "s"), (own.evader, "o")):
    axes.plot(*track.torso[-1, :2], marker, color="0.2")
axes.set_aspect("equal")
axes.set_xlabel("x [m]")
axes.set_ylabel("y [m]")
axes.legend()

# %% [markdown]
# ## From the command line
#
# In a file of its own, the class plays in every command:
# `stepaside duel --strategy evader.py:BackAndAside`, also in `study`,
# `view`, and `play` on a robot. A strategy must be pure: what it remembers
# goes through `memory` ([strategies](../strategies.md)).
#
# Many games say more than one: `stepaside study rating --set
# evader=evader.py:BackAndAside,evasion` rates it beside the paper's evader
# against a fixed suite of opponents, and `stepaside study duels --set
# evader.strategy=evader.py:BackAndAside` plays humanoids from forty random
# starts ([studies](../campaigns.md)).
