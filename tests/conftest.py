"""One thread for each worker, and no test that a slow machine can fail.

No test bounds the time that passes: those of loops wait for events, those of
pace have a clock of their own, and the limit on each test (``timeout`` in
``pyproject.toml``) is for what hangs.
"""

import os

for name in ("OPENBLAS", "OMP", "NUMBA"):
    os.environ.setdefault(f"{name}_NUM_THREADS", "1")

from hypothesis import HealthCheck, settings  # noqa: E402

settings.register_profile(
    "untimed",
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("untimed")
