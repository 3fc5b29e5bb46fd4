"""Test what can be tested of the recipes without their libraries."""

import re
import shlex
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any
from unittest.mock import Mock

import pytest

from stepaside import load_strategy
from stepaside.cli.main import main
from stepaside.studies import load_study

DOCS = Path(__file__).parents[2] / "docs"
RECIPES = sorted(DOCS.glob("recipe-*.md"))


def blocks(page: Path, language: str) -> list[str]:
    text = page.read_text("utf-8")
    return re.findall(rf"```{language}\n(.*?)```", text, flags=re.DOTALL)


@pytest.mark.parametrize("page", RECIPES, ids=lambda page: str(page.stem))
def test_every_command_of_a_recipe_has_its_options(page: Path) -> None:
    lines = "".join(blocks(page, "sh")).splitlines()
    commands = [shlex.split(x) for x in lines if x.startswith("stepaside ")]
    assert len(commands) >= 2
    for _, *words in commands:
        command: Any = main
        while hasattr(command, "get_command"):
            command = command.get_command(None, words.pop(0))
        known = {o for param in command.params for o in param.opts}
        given = {word for word in words if re.match("--|-o$", word)}
        assert given <= known, (command.name, given - known)


def test_the_study_of_the_paper_has_twenty_duels(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = DOCS / "recipe-paper.md"
    monkeypatch.chdir(tmp_path)
    Path("mine.py").write_text(blocks(page, "python")[0])
    Path("near.toml").write_text(blocks(page, "toml")[0])
    assert len(load_study(Path("near.toml")).cases) == 4 * 5
    names = set(re.findall(r"mine\.py:[^\"]*", Path("near.toml").read_text()))
    assert len(names) == 3
    for name in names:
        assert load_strategy(name).near == float(name[-4:-1])  # type: ignore[attr-defined]


def test_the_detector_reports_a_person_who_comes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Stand-ins for ROS 2; ``make ros2-peers`` has real nodes."""
    sent: list[Any] = []
    heard: dict[str, Any] = {}

    def module(name: str, **content: Any) -> None:
        made = ModuleType(name)
        made.__dict__.update(content)
        monkeypatch.setitem(sys.modules, name, made)

    def pose() -> Any:
        return SimpleNamespace(position=SimpleNamespace(x=0.0, y=0.0))

    def publisher(kind: Any, topic: str, depth: int) -> Any:
        heard["published"] = topic
        return SimpleNamespace(publish=sent.append)

    def subscription(kind: Any, topic: str, report: Any, depth: int) -> None:
        heard["report"] = report

    node = SimpleNamespace(
        create_publisher=publisher, create_subscription=subscription
    )
    stopped = Mock(side_effect=EOFError)  # by SIGTERM
    module("rclpy", create_node=lambda _: node, init=Mock(), spin=stopped)
    module("rclpy.executors", ExternalShutdownException=EOFError)
    module("geometry_msgs")
    module("geometry_msgs.msg", Pose=pose, PoseArray=SimpleNamespace)
    module("nav_msgs")
    module("nav_msgs.msg", Odometry=SimpleNamespace)
    (detector,) = blocks(DOCS / "recipe-people.md", "python")
    exec(compile(detector, "fake_detector.py", "exec"), {})
    for second in (0, 4):
        stamp = SimpleNamespace(sec=second, nanosec=500_000_000)
        header = SimpleNamespace(stamp=stamp, frame_id="g1/odom")
        heard["report"](SimpleNamespace(header=header))
    first, last = sent
    assert last.header.frame_id == "g1/odom"
    assert first.poses[0].position.x == pytest.approx(4.75)
    assert last.poses[0].position.x == pytest.approx(2.75)
    topic = heard["published"].replace("/g1/", "/my_robot/")
    assert f"| `{topic}` |" in (DOCS / "robots-real.md").read_text("utf-8")
