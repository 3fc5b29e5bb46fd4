# %% [markdown]
# # A study with a sweep and a figure
#
# How does the angle at which the evader moves away change how near the
# pursuer comes? A study answers with one file: what all games share, and what
# varies. The games run on all cores; results are stored as they come, and
# the same command continues after Ctrl-C.

# %%
from pathlib import Path

_ = Path("angle.toml").write_text("""\
game = "unicycles"

[settings]
pursuer_speed = 0.1
evader_speed = 0.1
pursuer_gain = 0.2
evader_gain = 0.2
aim = 0.0
bearing = 0.0
duration = 120.0

[grid]
angle = {first = 0.4, last = 1.6, number = 7}
distance = [0.8, 1.2]
""")

# %% [markdown]
# The command prints outcomes and a value for each combination.

# %% language="bash"
# stepaside study angle.toml --output angle.sqlite

# %% [markdown]
# ## The table
#
# The results are rows of a table, which SQLite, pandas and polars open.

# %%
import sqlite3

with sqlite3.connect("angle.sqlite") as table:
    rows = table.execute(
        "select distance, angle, closest_m from results order by angle"
    ).fetchall()
rows[:3]

# %%
import matplotlib.pyplot as plt

plt.figure(figsize=(6, 3.5))
for distance, marker in ((0.8, "o-"), (1.2, "s--")):
    curve = [row[1:] for row in rows if row[0] == distance]
    plt.plot(
        *zip(*curve, strict=True), marker, label=f"{distance} m apart at first"
    )
plt.xlabel("angle of the evader [rad]")
plt.ylabel("closest approach [m]")
plt.legend()

# %% [markdown]
# Against this pursuer a smaller angle keeps farther away: the evader backs
# off more and crosses less. Physics takes the same file with `game = "duel"`
# and the settings of a duel ([studies](../campaigns.md)); several machines
# share one study with `--shard` or a cluster with `--executor`.
