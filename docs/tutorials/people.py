# %% [markdown]
# # People
#
# A person walks straight at the robot at 1 m/s. The robot sees the person,
# computes from bearing, distance and velocity when it has to begin, and walks
# across the line of approach.

# %% language="bash"
# stepaside duel --gait fast --pursuer person --set person.path=straight \
#     --set person.speed=1 --duration 12 --seed 3 --output person

# %%
from IPython.display import Image

Image("person/duel.png", width=720)

# %% [markdown]
# ## How near does a person come?
#
# The paper's legs walk at most 0.26 m/s, so the answer depends on when the
# robot begins. `stepaside study people` measures it for speeds, directions
# and aims ([evading people](../people.md)); with a learned walking policy
# (`legs.network=FILE.onnx`) a humanoid moves at about 1 m/s, also sideways
# ([learned legs](../legs.md)).

# %% language="bash"
# for speed in 0.4 0.7 1.0 1.3; do
#     stepaside duel --gait fast --pursuer person --set person.path=straight \
#         --set person.speed=$speed --duration 25 --seed 3 --json \
#         > speed-$speed.json
# done

# %%
import json
from pathlib import Path

import matplotlib.pyplot as plt

speeds = (0.4, 0.7, 1.0, 1.3)
closest = [
    json.loads(Path(f"speed-{speed}.json").read_text())["min_distance_m"]
    for speed in speeds
]
plt.figure(figsize=(6, 3))
plt.plot(speeds, closest, "o-", color="#1f5fbf")
plt.xlabel("speed of the person [m/s]")
plt.ylabel("closest approach [m]")
plt.ylim(0.0, None)
