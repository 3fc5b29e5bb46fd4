"""Test ``serve`` and ``play`` of robots that walk by themselves, in words."""

from pathlib import Path

import pytest

from stepaside.cli.main import main
from stored_values import rows_of

ADAPTERS = Path(__file__).parents[2] / "examples" / "adapters"
WALKER = f"{ADAPTERS / 'walker_robot.py'}:WalkerRobot"


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """Return the message for invalid arguments."""
    with pytest.raises(SystemExit) as left:
        main(list(words))
    assert left.value.code == 2
    said = capsys.readouterr().err.strip().splitlines()[-1]
    assert said.startswith("stepaside: ")
    return said


@pytest.mark.parametrize(
    ("words", "said"),
    rows_of("test_errors_are_reported_in_one_line"),
)
def test_errors_are_reported_in_one_line(
    words: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("cyclonedds")
    assert said in refused(capsys, *words.replace("WALKER", WALKER).split())
