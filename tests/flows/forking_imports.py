"""Everything that a command may import, for :mod:`flows.forking`."""

import os

for name in ("OPENBLAS", "OMP", "NUMBA"):
    os.environ.setdefault(f"{name}_NUM_THREADS", "1")

import matplotlib.backends.backend_agg  # noqa: E402, F401
import matplotlib.figure  # noqa: E402, F401

import stepaside  # noqa: E402
from stepaside.cli.main import all_commands  # noqa: E402
from stepaside.core.compilation import load_numba  # noqa: E402
from stepaside.report.figure_style import plt  # noqa: E402

all_commands()
load_numba()
for name in stepaside.__all__:
    getattr(stepaside, name)

# Small figures without layout, as everywhere in the tests.
plt.rcParams.update({"savefig.dpi": 30})
