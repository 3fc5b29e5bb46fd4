"""Options of all commands: documented, and derived from settings."""

import subprocess
import sys
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from stepaside.cli.command_list import all_commands
from stepaside.cli.main import main
from stepaside.cli.options import output_file
from stored_values import compare_stored

SCREEN = 50  # lines
MOST = 16  # options, with --set, --config, --settings, --output and --json


def options_of(name: str) -> list[click.Option]:
    params = all_commands()[name].params
    return [param for param in params if isinstance(param, click.Option)]


def test_an_output_without_suffix_gets_the_first_one(tmp_path: Path) -> None:
    kind = output_file("figure", ".png", ".svg")
    for name, written in (("a", "a.png"), ("b.svg", "b.svg")):
        found = kind.convert(str(tmp_path / name), None, None)
        assert found == tmp_path / written


@pytest.mark.parametrize("name", all_commands())
def test_options_are_those_that_are_stored_and_their_help_fits_one_screen(
    name: str,
) -> None:
    shown = CliRunner().invoke(main, [*name.split(), "--help"]).stdout
    assert shown.count("\n") <= SCREEN
    assert len(options_of(name)) <= MOST
    for option in options_of(name):
        assert option.help and len(option.help) > 5, option.opts
        assert "{" not in option.help, option.opts
    found: list[str] = []
    for each in all_commands()[name].params:
        known = isinstance(each.default, int | float | str | tuple | Path)
        found.append(
            f"{each.opts} {each.secondary_opts} {each.type.to_info_dict()} "
            f"{(known and each.default) or None} {each.metavar} "
            f"{each.multiple} {each.required}"
        )
    compare_stored("options.json", name, found)


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
    code = """if True:
        import sys
        from stepaside.cli.command_list import all_commands
        all_commands()
        bad = {"mujoco", "scipy", "matplotlib"} & set(sys.modules)
        assert not bad, bad
        """
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.slow
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
