"""One thread for each worker, and no test that a slow machine can fail.

No test bounds the time that passes: those of loops wait for events, those of
pace have a clock of their own, and the limit on each test (``timeout`` in
``pyproject.toml``) is for what hangs.
"""

import gc
import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import suppress
from hashlib import sha256
from importlib import import_module
from pathlib import Path

for name in ("OPENBLAS", "OMP", "NUMBA"):
    os.environ.setdefault(f"{name}_NUM_THREADS", "1")
# A shell that starts us in the background lets Ctrl-C pass by; tests press it.
if threading.current_thread() is threading.main_thread():
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)

import pytest  # noqa: E402
from hypothesis import HealthCheck, settings  # noqa: E402

settings.register_profile(
    "untimed",
    deadline=None,
    max_examples=40,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("untimed")

# Tests that call the same compiled functions share a worker, by the beginning
# of their path below tests/: one worker compiles them.
COMPILED = {
    "theory/test_barrier": "bound",
    "theory/": "unicycle",
    "strategies/test_beam_search": "beam",
    "strategies/test_robust_evasion": "beam",
    "strategies/test_look_ahead": "steps",
    "strategies/test_step_motion": "steps",
    "control/test_clearance": "steps",
}
# Begin first, so that no worker is left alone with one at the end.
LONG = (
    *("browser", "bound", "unicycle", "steps", "beam"),
    *("test_duel", "test_walk_game", "test_seeing", "test_robot_init"),
)
BLANK = b"\x89PNG" + bytes(10_000) + b"IEND...."  # a figure


@pytest.fixture(scope="session", autouse=True)
def tables_of_this_code() -> Iterator[None]:
    """Solve tables of values anew after a change of what solves them."""
    from stepaside.core.compiled_cache import cache_folder
    from stepaside.theory.value import table

    files = sorted(Path(table.__file__).parent.glob("*.py"))
    digest = sha256(b"".join(each.read_bytes() for each in files)).hexdigest()
    folder = cache_folder() / f"tables-{digest[:16]}"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(table, "cache_folder", lambda: folder)
        yield


@pytest.fixture(scope="session", autouse=True)
def plain_figures() -> Iterator[None]:
    """Draw small figures without layout; their content is the same."""
    from stepaside.report.figure_style import plt

    with plt.rc_context({"savefig.dpi": 30}):
        yield


@pytest.fixture
def blank_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Write figures without drawing them, which takes half a second."""
    monkeypatch.setattr(
        "matplotlib.figure.Figure.savefig",
        lambda figure, file, **_: file.write(BLANK),
    )


@pytest.fixture
def inline_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Run in this process what workers would."""
    from stepaside.core import worker_pool
    from stepaside.studies.study import InlineExecutor

    monkeypatch.setattr(worker_pool, "worker_pool", lambda _: InlineExecutor())


@pytest.hookimpl(tryfirst=True)
def pytest_collection(session: pytest.Session) -> None:
    """Let every second worker import the tests from the last on.

    Workers compile each file that none has compiled yet, which takes longer
    than all imports; from both ends, each compiles half of them.
    """
    worker = getattr(session.config, "workerinput", {"workerid": "gw0"})
    if int(worker["workerid"].removeprefix("gw")) % 2 == 0:
        return
    given = [Path(each.partition("::")[0]) for each in session.config.args]
    folders = [each for each in given if each.is_dir()]
    files = [file for each in folders for file in each.rglob("test_*.py")]
    for file in sorted(files, reverse=True):
        if str(file.parent) not in sys.path:
            sys.path.insert(0, str(file.parent))
        # What fails here is reported when it is collected.
        with suppress(Exception, pytest.skip.Exception):
            import_module(file.stem)


def pytest_collection_finish() -> None:
    """Keep thousands of tests out of each collection of garbage."""
    gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let tests of a file, and of the same compiled code, share a worker.

    What a module makes once for its tests is made by one worker then.
    """
    for item in items:
        if item.get_closest_marker("xdist_group") is None:
            group = item.path.stem
            below = f"{item.path.parent.name}/{group}"
            for prefix, compiled in COMPILED.items():
                if below.startswith(prefix):
                    group = compiled
                    break
            item.add_marker(pytest.mark.xdist_group(group))
    items.sort(key=_turn)


def _turn(item: pytest.Item) -> int:
    """When a test has its turn: what takes long in one worker goes first."""
    mark = item.get_closest_marker("xdist_group")
    group = mark.args[0] if mark else ""
    return LONG.index(group) if group in LONG else len(LONG)
