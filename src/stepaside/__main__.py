"""Entry point of ``stepaside`` and ``python -m stepaside``."""

import gc
import os

# Containers made between two searches for garbage in cycles: imports and the
# start of a game make about a hundred thousand, and none of them is garbage.
GARBAGE = 300_000


def main() -> None:
    """Run the command line; exit with status 130 on Ctrl-C during import."""
    gc.set_threshold(GARBAGE)
    try:
        from .core.signal_handling import interruptible

        with interruptible():
            from .cli.main import main as run

            run()
    except KeyboardInterrupt:
        os.write(2, b"stepaside: interrupted; nothing is kept\n")
        raise SystemExit(130) from None


if __name__ == "__main__":
    main()
