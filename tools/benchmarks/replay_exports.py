"""Measure time and size of a run written as a page, a video and a GIF.

::

    python tools/benchmarks/replay_exports.py --seed 7
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from benchmark_options import ask, machine
from click.testing import CliRunner

from stepaside.cli.main import main as stepaside
from stepaside.studies.result_files import header, write_result

GIF = (
    "--begin 4 --duration 16 --speed 2 --camera follow --rate 8 "
    "--width 480 --height 270"
)
FILES = {
    "html": ("run.html", ""),
    "video": ("run.mp4", "--duration 60 --width 1280 --height 720"),
    "gif": ("run.gif", GIF),
}


def call(*words: str) -> None:
    """Call ``stepaside``, and exit if it fails."""
    answer = CliRunner().invoke(stepaside, words)
    if answer.exit_code:
        raise SystemExit(answer.output)


def main() -> None:
    """Run a duel, write each file, and write the results."""
    asked = ask(__doc__, "replay-exports.json")
    asked.add_argument("--seed", type=int, default=7)
    arguments = asked.parse_args()
    files = {}
    with TemporaryDirectory() as folder:
        run = str(Path(folder) / "run")
        call("duel", "--seed", str(arguments.seed), "--output", run)
        for kind, (name, more) in FILES.items():
            file = Path(folder) / name
            began = perf_counter()
            call("show", run, "-o", str(file), *more.split())
            files[kind] = {
                "wall_s": perf_counter() - began,
                "bytes": file.stat().st_size,
                "options": more,
            }
            print(kind, files[kind], flush=True)
    write_result(
        arguments.output,
        header({"seed": arguments.seed, "duration_s": 120.0}),
        machine=machine(),
        files=files,
    )


if __name__ == "__main__":
    main()
