# %% [markdown]
# # Train an evader
#
# `stepaside.envs` (extra `learn`) offers the games as environments of
# Gymnasium and PettingZoo. You look at one, train an evader by PPO, and let
# it play on a humanoid.
#
# ## An environment
#
# One decision per footstep; the opponent is the paper's pursuer. An action is
# a desired heading in [rad] and a speed factor.

# %%
import gymnasium

import stepaside.envs  # noqa: F401 - registers the environments

env = gymnasium.make("stepaside/Evade-v0", level="steps", opponent="pursuit")
observation, info = env.reset(seed=3)
print(observation)
total = 0.0
for _ in range(60):
    observation, reward, ended, cut_off, info = env.step([0.0, 1.0])
    total += float(reward)
    if ended or cut_off:
        break
print(f"walked straight back: closest approach {info['closest_m']:.3f} m")

# %% [markdown]
# ## Many at once
#
# The vector environment plays hundreds of games in one call, compiled. The
# learner, `train_evader.py` of the folder `examples` (put it beside
# the notebook), collects decisions from it and improves a small network.

# %%
from stepaside.envs import VectorDuel
from stepaside.games import duel
from train_evader import (
    OptimisationSettings,
    PolicyOptimiser,
)

UPDATES = 40
games = VectorDuel(
    256,
    role="evader",
    level="steps",
    any_heading=True,
    duel=duel(capture=0.02),
    action="discrete",
    full_state=True,
)
learner = PolicyOptimiser(games, OptimisationSettings(UPDATES), seed=1)
curve = [
    learner.update(n, 1.0 - n / UPDATES).closest_m for n in range(UPDATES)
]

# %%
import matplotlib.pyplot as plt

plt.figure(figsize=(6, 3))
plt.plot(curve, color="#1f5fbf")
plt.xlabel("update")
plt.ylabel("mean closest approach [m]")
# %% [markdown]
# ## On a humanoid
#
# The policy is an ONNX file and plays wherever a strategy does.

# %%
learner.strategy().save("evader.onnx")

# %% language="bash"
# stepaside duel --strategy evader.onnx --seed 3 --duration 40 --output game

# %%
from IPython.display import Image

Image("game/duel.png", width=720)

# %% [markdown]
# `examples/train_evader.py` trains longer and compares the result with the
# best possible closest approach; `stepaside study rating` does so for any
# strategy ([learning](../learning.md)).
