"""Time ``stepaside reproduce`` in a folder that holds nothing yet.

::

    python benchmarks/reproducing.py
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import json
import subprocess
import sys
from resource import RUSAGE_CHILDREN, getrusage
from tempfile import TemporaryDirectory
from time import perf_counter

from asking import ask, machine

from stepaside.studies.results import header, write_result
from stepaside.studies.version import PHYSICS

CALL = "from stepaside.cli import main; main()"


def main() -> None:
    """Reproduce, time and write."""
    arguments = ask(__doc__, "reproduce.json").parse_args()
    with TemporaryDirectory() as folder:
        words = [sys.executable, "-c", CALL, "reproduce", "--json"]
        began = perf_counter()
        answer = subprocess.run(
            [*words, "--output", folder], stdout=subprocess.PIPE, check=True
        )
        wall = perf_counter() - began
    used = getrusage(RUSAGE_CHILDREN)
    rows = json.loads(answer.stdout)
    write_result(
        arguments.output,
        header({"seed": 1}, rooms=(*PHYSICS, "studies", "report")),
        machine=machine(),
        wall_s=wall,
        processor_s=used.ru_utime + used.ru_stime,
        claims=len(rows),
        held=sum(row["verdict"] == "holds" for row in rows),
    )


if __name__ == "__main__":
    main()
