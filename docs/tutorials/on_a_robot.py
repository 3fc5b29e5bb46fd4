# %% [markdown]
# # On a robot
#
# On a real robot the controller is a process of its own, which talks to the
# robot over a protocol. `serve` simulates robots that speak these protocols,
# so the same commands run without one. You start a simulated world with two
# NAOs over LoLA and one controller for each.

# %% language="bash"
# stepaside serve --lola pursuer=P.sock --lola evader=E.sock \
#     --duration 20 --lockstep --json > result.json &
# stepaside play lola:P.sock --role pursuer \
#     --set wait=60 --record pursuer &
# stepaside play lola:E.sock --role evader \
#     --set wait=60 --record evader
# wait

# %% [markdown]
# The world reports what happened, with the timing of the controllers:

# %%
import json

with open("result.json") as file:
    result = json.load(file)
for key in ("outcome", "duration_s", "distance_m", "min_distance_m"):
    print(f"{key:15} {result[key]}")

# %% [markdown]
# Each controller recorded what its robot measured and was told:

# %% language="bash"
# ls evader
# stepaside show pursuer evader -o plays.png

# %%
from IPython.display import Image

Image("plays.png", width=720)

# %% [markdown]
# Their outcome is `failed` because the simulated world ended before them, and
# with it the connection; on a robot, `--duration` or its chest button ends a
# game.
#
# For a real robot replace `lola:E.sock` by its address; read
# [real robots](../robots-real.md) first: states, buttons, what stops the
# robot, and what was tested.
