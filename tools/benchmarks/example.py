"""Run the duel of the README, for its printed output and its figure.

The trajectories are stored next to the results, every 40 ms and to 0.1 mm,
which is sufficient for a figure::

    python tools/benchmarks/example.py --seed 7
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import json
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from benchmark_options import ask, machine
from click.testing import CliRunner
from result_files import header, write_result

from stepaside.cli.main import main as stepaside
from stepaside.core.poses import Array

EVERY = 2  # in samples of 20 ms
DECIMALS = 4
# Columns that the figure does not show.
LEFT_OUT = ("pursuer_qpos", "evader_qpos")


def play(seed: int, run: Path) -> str:
    """Run a duel into a run folder; return the printed output."""
    words = ["duel", "--seed", str(seed), "--output", str(run)]
    answer = CliRunner().invoke(stepaside, words)
    if answer.exit_code:
        raise SystemExit(answer.output)
    lines = answer.stdout.splitlines()
    # The paths below the empty line differ between machines.
    return "\n".join(lines[: lines.index("")])


def thinned(run: Path) -> dict[str, Array]:
    """Return the trajectories of a run folder at a figure's resolution."""
    tracks = {}
    with np.load(run / "trajectories.npz") as arrays:
        number = len(arrays["times_s"])
        for name in arrays.files:
            values = arrays[name]
            if name in LEFT_OUT:
                continue
            if len(values) == number:
                values = values[::EVERY]
            tracks[name] = np.round(values, DECIMALS).astype(np.float32)
    return tracks


def main() -> None:
    """Run the duel and write the results."""
    asked = ask(__doc__, "duel-seed7.json")
    asked.add_argument("--seed", type=int, default=7)
    arguments = asked.parse_args()
    output: Path = arguments.output
    with TemporaryDirectory() as folder:
        run = Path(folder) / "run"
        text = play(arguments.seed, run)
        summary = json.loads((run / "summary.json").read_text("utf-8"))
        tracks = output.with_suffix(".npz")
        output.parent.mkdir(parents=True, exist_ok=True)
        np.savez_compressed(tracks, allow_pickle=False, **thinned(run))
    digest = sha256(tracks.read_bytes()).hexdigest()
    write_result(
        output,
        header({"seed": arguments.seed, "duration_s": summary["duration_s"]}),
        machine=machine(),
        printed=text,
        summary=summary,
        trajectories={"file": tracks.name, "sha256": digest},
    )
    print(text)


if __name__ == "__main__":
    main()
