# %% [markdown]
# # A humanoid of yours
#
# From a model file (MJCF or URDF) to a duel, without code. Here the model is
# NAO's own, written as a file; put the file of your robot in its place.

# %% language="bash"
# stepaside robot nao --mjcf > humanoid.xml

# %% [markdown]
# ## Describe it
#
# `robot init` finds torso, legs and soles, computes a standing posture, servo
# gains and a gait, and writes one file with a comment on each value.

# %% language="bash"
# stepaside robot init humanoid.xml --output humanoid

# %% language="bash"
# head -30 humanoid/robot.toml

# %% [markdown]
# ## Check it
#
# The robot walks forward, backward and turning, and each property gets a
# verdict.

# %% language="bash"
# stepaside robot check humanoid --figure humanoid.png

# %%
from IPython.display import Image

Image("humanoid.png", width=500)

# %% [markdown]
# ## Play
#
# Two of them, for a minute.

# %% language="bash"
# stepaside duel --robot humanoid --seed 7 --duration 60 --output game

# %%
Image("game/duel.png", width=720)

# %% [markdown]
# A robot that is not steady yet is improved by `stepaside robot tune`
# ([your own humanoid](../robots.md)); one with a learned walking policy takes
# it with `--set legs.network=FILE.onnx` ([learned legs](../legs.md)).
