"""Entry point of ``stepaside`` and ``python -m stepaside``."""

import gc
import os
import sys

# Containers made between two searches for garbage in cycles: imports and the
# start of a game make about a hundred thousand, and none of them is garbage.
GARBAGE = 300_000
SIGNALLED = 128  # exit statuses above are those of a signal


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
    except SystemExit as ended:
        # Threads that wait for a lock which Ctrl-C left taken never end, and
        # those of NAOqi's library may crash while Python ends.
        if isinstance(ended.code, int) and (
            ended.code > SIGNALLED or "qi" in sys.modules
        ):
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(ended.code)
        raise


if __name__ == "__main__":
    main()
