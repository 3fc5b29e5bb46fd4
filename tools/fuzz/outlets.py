"""Output options of all commands, from the command tree."""

from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

import click
import numpy as np

from stepaside.cli.main import all_commands
from stepaside.cli.options.parameter_types import OutputFile
from stepaside.fitting.requirements import RequirementCheck
from stepaside.fitting.robot_verification import VerificationReport
from torchscript_archives import Module, write_archive
from vendor_humanoid import mjcf

from .commands import base_of, options_of
from .short_reproduce import few_claims

# What makes a command shorter still, and lets it write.
LITTLE = {
    "bound": ["--json"],
    "replay": ["--width=64", "--height=64", "--duration=0.1", "--json"],
    "legs convert": ["--json"],
}
STUDY = """
game = "tournament"
settings.game.duration = 3.0
[grid]
evader = ["aside", "look-ahead"]
seed = "0:5"
"""
LAYER = """class Network(Module):
  def forward(self: __torch__.net.Network, x: Tensor) -> Tensor:
    return torch.linear(x, self.weight)
"""
FOUND = RequirementCheck("height", "pass", "0.3 m")


# What they read that read no run, made in a folder.
def _study(folder: Path) -> Path:
    file = folder / "study.toml"
    file.write_text(STUDY)
    return file


def _archive(folder: Path) -> Path:
    weight = np.eye(3, 20, dtype=np.float32)
    root = Module("__torch__.net.Network", {"weight": weight})
    file = folder / "network.pt"
    return write_archive(file, root, {"__torch__.net": LAYER})


READ: dict[str, Callable[[Path], Path]] = {
    "study": _study,
    "robot check": lambda _: Path("nao"),
    "robot init": mjcf,
    "legs convert": _archive,
}
# They write when others play with them, see test_play_full.py, or join the
# records of campaigns, see test_campaign_commands.py.
APART = {"serve", "play", "merge"}


def outlets(name: str) -> list[click.Option]:
    """Return the output options of a command."""
    return [option for option in options_of(name) if is_outlet(option)]


def is_outlet(option: click.Option) -> bool:
    """Return whether an option names an output."""
    kind = option.type
    if isinstance(kind, click.Path):
        return not kind.exists
    return isinstance(kind, OutputFile)


def writers() -> list[str]:
    """Return commands that write output without waiting for clients."""
    return [n for n in all_commands() if outlets(n) and n not in APART]


def files_of(name: str, place: Path) -> list[Path]:
    """Return all output files of a command within a folder."""
    return [
        place / f"{option.name}{(*_suffixes(option), '')[0]}"
        for option in outlets(name)
    ]


def words_of(name: str, run: Path, place: Path) -> list[str]:
    """Return the arguments of a short command that writes all its outputs.

    Args:
        name: Name of the command.
        run: Run folder, for commands that read one; inputs of other commands
            are created next to it.
        place: Output folder.
    """
    read = READ[name](run.parent) if name in READ else run
    words = [*name.split(), *base_of(name, read), *LITTLE.get(name, ())]
    for option, file in zip(outlets(name), files_of(name, place), strict=True):
        words.append(f"{option.opts[0]}={file}")
    return words


def _suffixes(option: click.Option) -> tuple[str, ...]:
    kind = option.type
    return kind.suffixes if isinstance(kind, OutputFile) else ()


class Here(Executor):
    """Executor that runs tasks immediately in this process."""

    def submit(self, *task: Any, **more: Any) -> Future[Any]:
        """Run a task."""
        future: Future[Any] = Future()
        try:
            future.set_result(task[0](*task[1:], **more))
        except Exception as error:
            future.set_exception(error)
        return future


@contextmanager
def quickly() -> Iterator[None]:
    """Reduce the work of commands, and run it in this process."""
    from stepaside.cli import robot_check
    from stepaside.report import film
    from stepaside.studies import robustness_campaign as robustness

    with ExitStack() as stack:
        for place, name, instead in (
            ("stepaside.core.worker_pool", "worker_pool", lambda *_: Here()),
            (
                robustness.__name__,
                "run_trial",
                lambda trial: {"survived": True},
            ),
            (film.__name__, "worker_pool", lambda *_: Here()),
            (
                robot_check.__name__,
                "_check",
                lambda *_: VerificationReport((FOUND,), (), feedback=False),
            ),
        ):
            stack.enter_context(patch(f"{place}.{name}", instead))
        stack.enter_context(few_claims())
        yield
