"""Test what the command line and the documents should do and say."""

import re
from pathlib import Path
from signal import SIG_IGN, SIGHUP, SIGINT, SIGTERM, getsignal

import pytest

from expected.asking import GAME, command, own_evader
from stepaside.cli.command_list import all_commands

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
BOM = b"\xef\xbb\xbf"


@pytest.mark.parametrize("number", [SIGHUP, SIGTERM, SIGINT])
def test_the_status_of_a_command_is_that_of_its_signal(
    number: int, tmp_path: Path
) -> None:
    if getsignal(number) == SIG_IGN:
        pytest.skip("this signal is ignored here, as under nohup")
    own = own_evader(tmp_path / "own.py", number=int(number))
    words = ("duel", "--duration", 2, "--strategy", own)
    assert command(*words).exit_code == 128 + number


def test_a_file_that_is_replaced_keeps_its_mode(tmp_path: Path) -> None:
    figure = tmp_path / "plan.svg"
    figure.write_text("old")
    figure.chmod(0o600)
    words = ("--role", "evader", "--bearing", "40deg")
    done = command("theory", "plan", *words, "--figure", figure)
    assert done.exit_code == 0, done.output
    assert figure.read_text("utf-8") != "old"
    assert figure.stat().st_mode & 0o777 == 0o600


@pytest.mark.parametrize("kind", ["game", "configuration", "room"])
def test_a_file_may_begin_with_a_byte_order_mark(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Editors of Windows write one."""
    text, words = {
        "game": (GAME, ["run", "game"]),
        "configuration": (
            "duration = 0.5\n",
            ["duel", "--settings", "--config"],
        ),
        "room": ("width = 3.0\ndepth = 3.0\n", ["run", "room"]),
    }[kind]
    monkeypatch.chdir(tmp_path)  # games are written there
    file = tmp_path / "file.toml"
    file.write_bytes(BOM + text.encode())
    done = command(*words, file)
    assert done.exit_code == 0, done.output


def test_the_page_of_commands_says_who_takes_what() -> None:
    text = (DOCS / "commands.md").read_text("utf-8")
    (sentence,) = re.findall(r"Every command but (.*?) takes `--json`", text)
    without = {
        name
        for name, command in all_commands().items()
        if not any("--json" in param.opts for param in command.params)
    }
    assert set(re.findall(r"`(\w+)`", sentence)) == without


def test_the_first_page_installs_what_its_commands_need() -> None:
    text = (DOCS / "index.md").read_text("utf-8")
    (lines,) = re.findall(r"```sh\n(.*?)```", text, re.DOTALL)
    install, *commands = lines.splitlines()
    assert any("stepaside view" in command for command in commands)
    assert "[viewer]" in install


@pytest.mark.parametrize("name", ["DuelEnv", "GameSettings"])
def test_the_reference_has_environments_and_games(name: str) -> None:
    text = (DOCS / "api.md").read_text("utf-8")
    assert re.search(rf"^\.\. auto\w+:: .*\b{name}$", text, re.MULTILINE)


def test_the_recipe_for_ros_2_publishes_the_pose_of_the_other() -> None:
    recipe = (DOCS / "recipe-people.md").read_text("utf-8")
    (detector,) = re.findall(r"```python\n(.*?)```", recipe, re.DOTALL)
    (topic,) = re.findall(
        r'create_publisher\(PoseArray, "/g1/(.*?)"', detector
    )
    assert f"/{topic}` | " in (DOCS / "robots-real.md").read_text("utf-8")
    assert "play ros2:/g1 " in recipe


def test_one_duel_needs_no_tools_of_developers() -> None:
    text = (ROOT / "Makefile").read_text("utf-8")
    (needs,) = re.findall(r"^duel:(.*)$", text, re.MULTILINE)
    assert needs.split() != ["setup"]


def test_formulas_need_no_network() -> None:
    text = (DOCS / "conf.py").read_text("utf-8")
    (renderer,) = re.findall(r'^html_math_renderer = "(.*)"$', text, re.M)
    assert renderer == "mathml" and "mathjax" not in text
