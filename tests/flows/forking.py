"""Commands in forks of a process that has imported the package already.

Importing takes a second for each command, which is most of what a short game
takes. A fork has the arguments, folder, files and exit status of a command
that was started anew; :mod:`flows.test_first_steps` starts one anew.
"""

import os
import resource
import sys
from multiprocessing import forkserver, get_context
from pathlib import Path
from tempfile import TemporaryDirectory

from pytest import MonkeyPatch

IMPORTS = "flows.forking_imports"
CONTEXT = get_context("forkserver")
CONTEXT.set_forkserver_preload([IMPORTS])


def start_server() -> None:
    """Start the process that is forked, unless it runs.

    It looks for what it imports on the path of the environment alone, and
    goes on without what it does not find.
    """
    with MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", os.pathsep.join(filter(None, sys.path)))
        forkserver.ensure_running()


def run_forked(
    words: list[str],
    folder: Path,
    environment: dict[str, str],
    largest_file: int | None,
    timeout: float,
) -> tuple[int, str, str]:
    """Run a command; return exit status, standard output and error.

    Args:
        words: Arguments of the command.
        folder: Where it runs.
        environment: All variables.
        largest_file: Size at which writing fails, in [bytes].
        timeout: In [s].
    """
    start_server()
    with TemporaryDirectory() as kept:
        said = Path(kept) / "out", Path(kept) / "err"
        process = CONTEXT.Process(
            target=_run, args=(words, folder, said, environment, largest_file)
        )
        process.start()
        process.join(timeout)
        status = process.exitcode
        process.kill()
        assert status is not None, f"{words} did not end"
        return status, said[0].read_text(), said[1].read_text()


def _run(
    words: list[str],
    folder: Path,
    said: tuple[Path, Path],
    environment: dict[str, str],
    largest_file: int | None,
) -> None:
    assert IMPORTS in sys.modules, "the forked process imported nothing"
    from stepaside.__main__ import main

    os.environ.clear()
    os.environ.update(environment)
    sys.dont_write_bytecode = "PYTHONDONTWRITEBYTECODE" in environment
    os.chdir(folder)
    for number, file in enumerate(said, start=1):
        opened = os.open(file, os.O_WRONLY | os.O_CREAT)
        os.dup2(opened, number)
    if largest_file is not None:
        size = largest_file, largest_file
        resource.setrlimit(resource.RLIMIT_FSIZE, size)
    sys.argv = ["stepaside", *words]
    main()
