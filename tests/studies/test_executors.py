"""Test the same study on executors of clusters, each as installed here."""

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from stepaside.studies.campaign import CodeStamp, Study, run_study
from stepaside.studies.executors import Engine, open_engine
from stepaside.studies.records import Record

BIN = Path(sys.executable).parent
STAMP = CodeStamp("1", {})


def square(case: int) -> Record:
    return {"square": case * case}


def kill_once(folder: str, case: int) -> Record:
    """End the worker process at the first attempt of a case."""
    mark = Path(folder) / "killed"
    if case == 5 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return square(case)


def squares(engine: Engine, measure: object = square) -> list[int]:
    study: Study[int] = Study(
        *("squares", range(50), measure, str, lambda case: STAMP)  # type: ignore[arg-type]
    )
    run = run_study(study, None, engine)
    return [record["square"] for record in run.records()]


@pytest.fixture(scope="module")
def dask() -> Iterator[Engine]:
    pytest.importorskip("distributed")
    with open_engine("dask", 2) as engine:
        yield engine


def test_dask_gives_the_records_of_one_process(dask: Engine) -> None:
    assert dask.workers == 2
    assert squares(dask) == squares(Engine.of(None))


def test_dask_repeats_cases_of_a_killed_worker(
    dask: Engine, tmp_path: Path
) -> None:
    measure = partial(kill_once, str(tmp_path))
    assert squares(dask, measure) == squares(Engine.of(None))


RANKS = """
from test_executors import open_engine, squares
if __name__ == "__main__":
    with open_engine("mpi") as engine:
        print(engine.workers, sum(squares(engine)))
"""


def test_mpi_gives_the_records_of_one_process(tmp_path: Path) -> None:
    pytest.importorskip("mpi4py")
    mpiexec = shutil.which("mpiexec", path=f"{BIN}:{os.environ['PATH']}")
    if mpiexec is None:
        pytest.skip("no mpiexec: an MPI library is not installed")
    script = tmp_path / "ranks.py"
    script.write_text(RANKS)
    rooted = ("OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM")
    found = subprocess.run(
        [
            *(mpiexec, "--oversubscribe", "-n", "3", sys.executable),
            *("-m", "mpi4py.futures", script),
        ],
        capture_output=True,
        text=True,
        env=os.environ
        | dict.fromkeys(rooted, "1")
        | {"PYTHONPATH": str(Path(__file__).parent)},
        timeout=120,
    )
    assert found.stdout.split() == ["2", "40425"], found.stderr
