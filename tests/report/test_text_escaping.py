"""Text of users is escaped wherever it is shown."""

import html
import json
import re
from io import StringIO
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

import stepaside
from injection_strings import HOSTILE
from stepaside.cli.main import main
from stepaside.core.errors import INVISIBLE, visible
from stepaside.games.run import Run
from stepaside.games.run_archive import write_run_files
from stepaside.games.trajectory import Trajectory
from stepaside.report.text_escaping import (
    fill_page,
    for_figure,
    for_markdown,
    for_script,
    policy_of,
)
from synthetic_run import run_of

TEXTS = st.text() | st.sampled_from(HOSTILE)
UNPAIRED = st.text(st.characters()) | st.sampled_from(HOSTILE)


def small_run(message: str) -> Run:
    """A run of two players who slide."""
    times = np.arange(0.0, 3.0, 0.5)
    rows = np.column_stack([times, 0.0 * times, 0.0 * times])
    tracks = {
        name: Trajectory(com=rows, torso=rows + side)
        for name, side in (("pursuer", 0.0), ("evader", 1.0))
    }
    return run_of(times, tracks, message=message)


@given(UNPAIRED)
def test_what_is_written_out_holds_nothing_unseen(text: str) -> None:
    from unicodedata import category

    assert not any(category(c) in INVISIBLE for c in visible(text))
    plain = "plain text, \u00e4 \u4e2d!"
    assert visible(plain) == plain
    assert visible("a\tb\n", but="\n\t") == "a\tb\n"


@given(TEXTS)
def test_json_in_a_script_holds_no_mark_and_is_the_same(text: str) -> None:
    value = {"a": [text, 1.5, None], text: True}
    written = for_script(value)
    assert not set("<>&\u2028\u2029") & set(written)
    assert json.loads(written) == value


def test_json_in_a_script_refuses_what_is_no_number() -> None:
    with pytest.raises(ValueError, match="JSON"):
        for_script(float("nan"))


@given(UNPAIRED)
def test_markdown_holds_none_of_its_marks(text: str) -> None:
    written = for_markdown(text)
    entities = re.sub(r"&#\d+;", "", written)
    assert all(c.isalnum() or c == " " or not c.isascii() for c in entities)
    assert html.unescape(written) == visible(text)


@given(UNPAIRED, UNPAIRED)
def test_a_page_is_filled_in_one_pass(name: str, word: str) -> None:
    template = "<h1>@@NAME@@</h1>\0@@RUN@@\0<i title='@@POLICY@@'>"
    page = fill_page(template, {"NAME": name}, [word])
    title, run, rest = page.split("\0")
    assert html.unescape(title[4:-5]) == visible(name)
    assert json.loads(run) == [word]
    assert page.count("<") == 3 and rest.count("'none'") == 3


def test_a_policy_allows_what_stands_in_the_page_alone() -> None:
    page = "<style>a</style><script>b</script><script id='d'>c</script>"
    policy = policy_of(page)
    assert policy.count("sha256-") == 2
    assert "default-src 'none'" in policy
    # Digests as any tool gives them for "a" and for "b".
    assert "ypeBEsobvcr6wjGzmiPcTaeG7/gUfE5yuYB3ha/uSLs=" in policy
    assert "PiPoFgA5WUoziU9lZOGxNIu9egCI1CxKy3PurtWcAJ0=" in policy
    assert policy_of(page.replace("b", "x")) != policy


def test_names_are_shown_literally_in_a_figure() -> None:
    from stepaside.report.figure_style import plt

    figure, axes = plt.subplots()
    for name in HOSTILE:
        axes.plot([0, 1], label=for_figure(name))
    axes.legend().set_gid("legend")
    drawn = StringIO()
    with plt.rc_context({"svg.fonttype": "none"}):
        figure.savefig(drawn, format="svg")
    plt.close(figure)
    legend = ElementTree.fromstring(drawn.getvalue()).find(
        ".//*[@id='legend']"
    )
    assert legend is not None
    texts = legend.iter("{http://www.w3.org/2000/svg}text")
    shown = ["".join(text.itertext()).strip() for text in texts]
    assert shown == [visible(name).strip() for name in HOSTILE]


@pytest.mark.parametrize("text", ["$\\frac{$", "\x1b[2J\x07", "_name", "a\nb"])
def test_runs_of_any_name_are_compared(tmp_path: Path, text: str) -> None:
    folder = tmp_path / text
    folder.mkdir()
    write_run_files(folder, small_run(message=text))
    output = tmp_path / "c.png"
    arguments = ["show", str(folder), str(folder), "-o", str(output)]
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 0, result.output
    assert output.stat().st_size > 1000
    assert "\x1b" not in result.output and "\x07" not in result.output
    assert f"\n{visible(text)} " in result.output


def test_a_refusal_writes_escape_sequences_out() -> None:
    result = CliRunner().invoke(main, ["show", "\x1b[2Jx\x9b"])
    assert result.exit_code == 2
    assert "\x1b" not in result.output and "\x9b" not in result.output
    assert "\\x1b[2Jx\\x9b" in result.output


def test_all_commands_write_through_the_terminal_module() -> None:
    root = Path(stepaside.__file__).parent
    files = list((root / "cli").rglob("*.py"))
    assert files
    for file in files:
        text = file.read_text(encoding="utf-8")
        writes = re.search(r"\bclick\.s?echo\(|(?<!\w)print\(", text)
        # main.py prints constant texts only.
        assert writes is None or file.name in ("terminal.py", "main.py"), file
