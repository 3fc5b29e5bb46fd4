# %% [markdown]
# # On a robot
#
# On a real robot the controller is a process of its own, which talks to the
# robot over a protocol. `serve` simulates robots on ROS 2 topics, so the
# same commands run without one. You start a simulated world with two NAOs
# and one controller for each.

# %% language="bash"
# stepaside play ros2:/p --role pursuer --set sim_time=true \
#     --set wait=60 --record pursuer &
# stepaside play ros2:/e --role evader --set sim_time=true \
#     --set wait=60 --record evader &
# stepaside serve --ros2 pursuer=/p --ros2 evader=/e \
#     --duration 20 --lockstep --json > result.json
# kill $(jobs -p)
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
# Their outcome is `interrupted`, as they were ended when the simulated world
# was; on a robot, `--duration` or Ctrl-C ends a game.
#
# For a real robot replace `ros2:/e` by its address; read
# [real robots](../robots-real.md) first: states, buttons, what stops the
# robot, and what was tested.
