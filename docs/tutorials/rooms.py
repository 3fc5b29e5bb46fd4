# %% [markdown]
# # Rooms
#
# Among walls and obstacles the paper's evader walks into a corner. The
# look-ahead evader plans: it rolls out its next maneuvers against the
# pursuer and keeps a way out.
#
# ## A room
#
# A seed makes a room; a file describes one (`stepaside run room --help`).

# %% language="bash"
# stepaside run room --seed 4 --width 3 --depth 3 --discs 3 --figure room.png \
#     --output room.toml

# %%
from IPython.display import Image

Image("room.png", width=420)

# %% [markdown]
# ## Play in it
#
# A guard checks each step, and the halt after it, against the obstacles, so a
# strategy decides how well the robot evades and not whether it hits a wall.

# %% language="bash"
# stepaside duel --room room.toml --strategy look-ahead \
#     --duration 60 --seed 3 --output game

# %%
Image("game/duel.png", width=720)

# %% [markdown]
# The pursuer above is the paper's, which turns slowly. Faster ones exist, and
# figures of survival name their opponent ([evading](../evading.md)).
