"""Everything that a command may import, for :mod:`flows.forking`."""

import os
from typing import Any

for name in ("OPENBLAS", "OMP", "NUMBA"):
    os.environ.setdefault(f"{name}_NUM_THREADS", "1")

import matplotlib.backends.backend_agg  # noqa: E402, F401
from matplotlib.figure import Figure  # noqa: E402

import stepaside  # noqa: E402
from stepaside.cli.command_list import all_commands  # noqa: E402
from stepaside.core.compilation import load_numba  # noqa: E402

all_commands()
load_numba()
for name in stepaside.__all__:
    getattr(stepaside, name)

BLANK = b"\x89PNG" + bytes(30_000) + b"IEND...."  # a figure
savefig = Figure.savefig


def save_blank(figure: Any, file: Any, **more: Any) -> None:
    """Write a figure as a blank image, which saves half a second."""
    if more.get("format") == "png":
        file.write(BLANK)
    else:
        savefig(figure, file, **more)


# The command that is started anew draws its figure.
Figure.savefig = save_blank  # type: ignore[assignment, method-assign]
