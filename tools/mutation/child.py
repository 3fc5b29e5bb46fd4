"""Forked processes that run tests in a scratch copy of the tree."""

import os
import re
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from resource import (
    RLIMIT_CPU,
    RUSAGE_CHILDREN,
    RUSAGE_SELF,
    getrlimit,
    getrusage,
    setrlimit,
)

import pytest
from hypothesis import HealthCheck, Phase, settings

PROFILE = "mutation"
# Imported before forking, if the tree imports them at all.
WARM = (
    "click.testing",
    "cv2",
    "dacite",
    "daqp",
    "markdown",
    "matplotlib.pyplot",
    "mujoco",
    "numba",
    "numpy",
    "scipy.integrate",
    "scipy.linalg",
    "scipy.optimize",
    "scipy.signal",
    "scipy.spatial",
    "tomli_w",
    "tqdm",
    "xml.etree.ElementTree",
)


def warm_up(root: Path) -> None:
    """Import the libraries that a tree uses, but nothing of the tree."""
    for name in ("OPENBLAS", "OMP", "NUMBA"):
        os.environ.setdefault(f"{name}_NUM_THREADS", "1")
    os.environ.setdefault("MPLBACKEND", "Agg")
    text = "\n".join(
        file.read_text(encoding="utf-8")
        for part in ("src", "tests")
        for file in sorted((root / part).rglob("*.py"))
    )
    for name in WARM:
        top = name.partition(".")[0]
        if re.search(rf"\b(import|from) {top}\b", text):
            with suppress(ImportError):
                import_module(name)
    settings.register_profile(
        PROFILE,
        deadline=None,
        suppress_health_check=[HealthCheck.too_slow],
        derandomize=True,
        database=None,
        phases=(Phase.explicit, Phase.generate),
    )


def cpu_time() -> float:
    """Return the processor time of this process and its children, in [s]."""
    both = getrusage(RUSAGE_SELF), getrusage(RUSAGE_CHILDREN)
    return sum(used.ru_utime + used.ru_stime for used in both)


def allow(seconds: float) -> None:
    """Limit the further processor time of this process."""
    used = getrusage(RUSAGE_SELF)
    limit = int(used.ru_utime + used.ru_stime + seconds) + 1
    setrlimit(RLIMIT_CPU, (limit, getrlimit(RLIMIT_CPU)[1]))


def fork(tree: Path, log: Path, work: Callable[[], None]) -> int:
    """Call a function in a forked process that imports from a tree.

    Args:
        tree: Scratch copy to work in.
        log: File for the output of the process.
        work: Function to call.

    Returns:
        Process identifier, also that of its process group.
    """
    child = os.fork()
    if child:
        return child
    status = 70
    try:
        os.setsid()
        _enter(tree, log)
        work()
        status = 0
    except BaseException as error:  # the fork must not return
        print(repr(error), flush=True)
    finally:
        sys.stdout.flush()
        os._exit(status)


def run_tests(
    tree: Path, files: Iterable[str], plugin: object, *options: str
) -> int:
    """Run tests of some files in this process; return pytest's exit status."""
    status = pytest.main(
        [
            *(str(tree / file) for file in files),
            "--quiet",
            "--tb=short",
            f"--rootdir={tree}",
            f"--config-file={tree / 'pyproject.toml'}",
            f"--basetemp={tree.parent / f'tmp-{tree.name}'}",
            f"--hypothesis-profile={PROFILE}",
            "-pno:cacheprovider",
            "-Wignore",
            *options,
        ],
        plugins=[plugin],
    )
    return int(status)


def _enter(tree: Path, log: Path) -> None:
    """Make a tree the working directory and the source of imports."""
    for name in list(sys.modules):  # used by the parent process
        if name.partition(".")[0] == "stepaside":
            del sys.modules[name]
    os.chdir(tree)
    paths = [str(tree / "src"), str(tree / "tests"), str(tree)]
    sys.path[:0] = paths
    os.environ["PYTHONPATH"] = os.pathsep.join(paths[:1])
    with open(os.devnull) as nothing, log.open("w") as out:
        os.dup2(nothing.fileno(), 0)
        os.dup2(out.fileno(), 1)
        os.dup2(out.fileno(), 2)
