"""``stepaside reproduce`` with a few short claims."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from unittest.mock import patch

FEW = ("circle", "path", "footsteps", "com")


@contextmanager
def few_claims() -> Iterator[None]:
    """Let ``reproduce`` measure a few claims and draw small figures."""
    from stepaside.cli import reproduce_figures
    from stepaside.studies import claim_campaign as reproduce
    from stepaside.studies.claim_jobs import JOBS

    few = {name: JOBS[name] for name in FEW}
    draw = partial(reproduce_figures.draw_figures, duration=0.5, marks=1)
    with (
        patch.object(reproduce, "JOBS", few),
        patch.object(reproduce_figures, "draw_figures", draw),
    ):
        yield


def main() -> None:
    """Run it, as ``stepaside`` does."""
    from stepaside.cli.main import main as run

    words = "reproduce --runs=1 --workers=2 --output"
    with few_claims():
        run([*words.split(), sys.argv[1]])


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:  # while it loads
        raise SystemExit(130) from None
