"""Version of all results, raised by hand when a game turns out otherwise."""

from functools import cache
from importlib.metadata import version

from .. import __version__

RESULTS = "2026.5"
"""Results version that each stored record carries.

A record counts only under the version that it was made with. The test
``tests/studies/test_results_version.py`` plays three seeds of each kind of
game; raise this version when their values change.
"""
LIBRARIES = ("mujoco", "numba", "numpy", "scipy")


@cache
def library_versions() -> dict[str, str]:
    """Return the versions of this package and of its libraries, by name."""
    return {"stepaside": __version__} | {x: version(x) for x in LIBRARIES}
