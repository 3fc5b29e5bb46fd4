"""Options of all commands: documented, and derived from settings."""

import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import click
import pytest
from click.testing import CliRunner

from stepaside.cli.main import COMMANDS, main
from stepaside.cli.options.parameter_types import (
    AngleType,
    NumberType,
    WordOrValueType,
)

SETTINGS = (
    *("duel", "play", "serve", "view"),
    *("walk", "plan"),
)


def options_of(name: str) -> list[click.Option]:
    context = click.Context(main)
    command = main.get_command(context, name)
    assert command is not None
    return [p for p in command.params if isinstance(p, click.Option)]


def every_option() -> Iterator[tuple[str, click.Option]]:
    for name in COMMANDS:
        for option in options_of(name):
            yield name, option


def told(name: str, option: click.Option) -> str:
    """Return the help of an option as it is shown."""
    command = main.get_command(click.Context(main), name)
    assert command is not None
    record = option.get_help_record(click.Context(command))
    assert record is not None
    return record[1]


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_has_a_meaning_and_a_unit(name: str) -> None:
    for option in options_of(name):
        text = told(name, option)
        assert len(text.split("[default")[0].strip()) > 5, option.opts
        assert "{" not in text, option.opts
        kind: Any = option.type
        if isinstance(kind, WordOrValueType):
            kind = kind.kind
        if isinstance(kind, NumberType):
            assert f"[{kind.unit}]" in text, option.opts
        if isinstance(kind, AngleType):
            assert "[rad]" in text, option.opts


@pytest.mark.parametrize("name", COMMANDS)
def test_every_flag_can_be_switched_off(name: str) -> None:
    for option in options_of(name):
        assert option.is_flag == bool(option.secondary_opts), option.opts


@pytest.mark.parametrize("name", SETTINGS)
def test_commands_with_robots_take_any_setting_and_a_file(name: str) -> None:
    spelled = {word for option in options_of(name) for word in option.opts}
    assert spelled >= {"--config", "--print-config", "--gait", "--set"}


@pytest.mark.parametrize("name", ["duel", "walk", "plan", "view", "play"])
def test_the_own_options_of_a_command_fit_one_screen(name: str) -> None:
    assert len(options_of(name)) <= 32


@pytest.mark.parametrize(
    ("given", "near"),
    [
        ("gait.strid=1", "gait.stride"),
        ("stride=0.03", "gait.stride"),
        ("person.sped=1", "person.speed"),
    ],
)
def test_an_unknown_setting_names_similar_ones(given: str, near: str) -> None:
    result = CliRunner().invoke(main, ["duel", "--set", given])
    assert result.exit_code == 2
    assert near in result.stderr and result.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("gait.stride", "PATH=VALUE"),
        ("strategy.saturated=yes", "true or false"),
        ("strategy.saturated=1", "true or false"),
        ("gait.stride=true", "gait.stride must be a number"),
        ("gait.horizon=2.5", "gait.horizon"),
        ("evader_strategy=nobody", "nobody"),
    ],
)
def test_a_bad_value_is_refused_by_its_setting(given: str, words: str) -> None:
    result = CliRunner().invoke(main, ["duel", "--set", given, "--json"])
    assert result.exit_code == 2 and words in result.stderr


def test_list_of_commands_imports_nothing() -> None:
    """Neither a command nor numpy."""
    code = (
        "import sys; from stepaside.cli.main import main\n"
        "try: main(['--help'])\n"
        "except SystemExit: pass\n"
        "bad = {m for m in sys.modules if m.startswith('stepaside.cli.')}"
        "\nbad -= {'stepaside.cli.main'}"
        "\nassert not bad and 'numpy' not in sys.modules, bad"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_commands_are_declared_without_heavy_imports() -> None:
    """MuJoCo, SciPy and Matplotlib are imported on use."""
    code = f"""if True:
        import sys
        from importlib import import_module
        for name in {list(COMMANDS)}:
            import_module(f"stepaside.cli.{{name}}")
            bad = {{"mujoco", "scipy", "matplotlib"}} & set(sys.modules)
            assert not bad, (name, bad)
        """
    subprocess.run([sys.executable, "-c", code], check=True)


def test_duel_without_figure_imports_no_plotting() -> None:
    """They would double the import time; Numba needs a part of SciPy."""
    code = """if True:
        import sys
        from stepaside.cli.main import main
        try:
            main(["duel", "--duration", "0.02", "--json"])
        except SystemExit as left:
            assert not left.code
        parts = "integrate interpolate optimize sparse spatial special"
        bad = {f"scipy.{part}" for part in parts.split()} | {"matplotlib"}
        bad &= set(sys.modules)
        assert not bad, bad
        """
    subprocess.run(
        [sys.executable, "-c", code], check=True, stdout=subprocess.DEVNULL
    )
