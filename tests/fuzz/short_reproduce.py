"""``stepaside reproduce`` of a few claims, with small figures."""

import sys
from functools import partial

FEW = ("circle", "path", "footsteps", "com")


def main() -> None:
    """Run it, as ``stepaside`` does."""
    from stepaside.cli import main as run
    from stepaside.commands import reproduce_figures
    from stepaside.studies import reproduce
    from stepaside.studies.jobs import JOBS

    few = {name: JOBS[name] for name in FEW}
    setattr(reproduce, "JOBS", few)  # noqa: B010 (it is not its own)
    reproduce_figures.draw_figures = partial(
        reproduce_figures.draw_figures, duration=0.5, marks=1
    )
    run(["reproduce", "--runs=1", "--workers=2", f"--output={sys.argv[1]}"])


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:  # while it loads
        raise SystemExit(130) from None
