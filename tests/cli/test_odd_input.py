"""Odd values of every option: one line with status 2, nothing written."""

from collections.abc import Iterator
from contextlib import chdir
from math import inf
from pathlib import Path
from tempfile import TemporaryDirectory

import click
import pytest
from click.testing import CliRunner
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from stepaside.cli.command_list import all_commands
from stepaside.cli.main import main

# They wait for clients, browsers or robots, or play long games.
WAITING = {"serve", "play", "view"}
EXAMPLE = Path(__file__).parents[2] / "examples" / "two-pursuers.toml"
SHORT = {
    "duel": ["--duration=0.02"],
    "run walk": ["--duration=0.02"],
    "run game": ["--duration=0.02"],
    "theory plan": ["--role=evader", "--bearing=0.3", "--steps=4"],
    "run unicycles": ["--duration=1"],
    "theory circle": ["--starts=2"],
    "theory map": ["--grid=2", "--set=distances=1", "--set=duration=1"],
    "theory bound": ["--grid=16", "--set=horizon=0.05"],
}
# They compute in this process as long as the numbers say.
COMPUTING = {name for name in SHORT if name.startswith("theory")} | {
    "run unicycles"
}
LARGE = 50.0
ODD = st.one_of(
    st.sampled_from(
        "nan inf -inf 1e400 -0 0x10 1_000 ١ 1deg 1e9rad -1 0 1,2 [] {} a:b "
        "\x1b[2J ../.. /dev/null /proc/self/mem".split()
    ),
    st.just(""),
    st.just("a" * 300),
    st.text(max_size=8).filter(lambda text: "\0" not in text),
    st.floats().map(repr),
    st.integers(-(2**70), 2**70).map(str),
)
OPTIONS = [
    (name, option)
    for name, command in sorted(all_commands().items())
    if name not in WAITING
    for option in command.params
    if isinstance(option, click.Option) and not option.is_flag
]


class Began(Exception):
    """The command would begin to simulate, here or in other processes."""


@pytest.fixture(scope="module")
def without_work() -> Iterator[None]:
    def begin(*_: object) -> None:
        raise Began

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("stepaside.core.worker_pool.worker_pool", begin)
        patch.setattr("stepaside.sim.world.World.step", begin)
        yield


def is_large(value: str) -> bool:
    """Whether it is a number of which much would be computed."""
    try:
        return LARGE < float(value) < inf
    except ValueError:
        return False


@pytest.mark.slow
@pytest.mark.usefixtures("without_work")
@settings(
    max_examples=80, suppress_health_check=[*HealthCheck], derandomize=True
)
@given(st.sampled_from(OPTIONS), ODD)
def test_an_odd_value_is_taken_or_refused_in_one_line(
    option: tuple[str, click.Option], value: str
) -> None:
    name, chosen = option
    assume(name not in COMPUTING or not is_large(value))
    command = all_commands()[name]
    files = [
        str(EXAMPLE)
        for param in command.params
        if isinstance(param, click.Argument) and param.required
    ]
    words = [*name.split(), *SHORT.get(name, ()), *files]
    with TemporaryDirectory() as folder, chdir(folder):
        words.append(f"{chosen.opts[0]}={value}")
        result = CliRunner().invoke(main, words)
        left = list(Path().rglob("*"))
    error = result.exception
    assert error is None or isinstance(error, SystemExit | Began), error
    if result.exit_code == 2:
        assert result.output.count("\n") == 1, result.output
        assert not left
