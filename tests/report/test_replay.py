"""Replay of a run: page from disk, films, comparison."""

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.games.run_archive import load_run
from stepaside.report.replay_page import (
    template,
    three_js,
    write_page,
)
from stepaside.sim.offscreen_rendering import RAYCAST, choose_renderer

needs_graphics = pytest.mark.skipif(
    choose_renderer() == RAYCAST,
    reason="neither EGL nor OSMesa works here",
)


pytestmark = pytest.mark.xdist_group("replay")


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "short"
    arguments = ["duel", "--seed", "3", "--duration", "6", "--json"]
    result = CliRunner().invoke(main, [*arguments, "--output", str(folder)])
    assert result.exit_code == 0
    return folder


def invoke(*arguments: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(main, list(arguments))
    return result.exit_code, result.stdout, result.stderr


def test_the_page_needs_nothing_from_outside(
    run: Path, tmp_path: Path
) -> None:
    file = tmp_path / "run.html"
    write_page(load_run(run), file)
    # three.js contains the address of its bug tracker; the policy blocks it.
    text = file.read_text(encoding="utf-8").replace(three_js(), "")
    assert "default-src 'none'" in text and "connect-src" not in text
    assert not re.search(r"(src|href)\s*=|https?://|@@", text)
    assert [p.name for p in tmp_path.iterdir()] == ["run.html"]


def test_two_minutes_fit_into_six_megabytes(run: Path, tmp_path: Path) -> None:
    file = tmp_path / "run.html"
    write_page(load_run(run), file)
    constant = len(template())
    # Upper bound: everything else grows with time.
    rest = file.stat().st_size - constant
    assert constant + rest * 120.0 / 6.0 < 6e6


@needs_graphics
def test_a_gif_moves(run: Path, tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    file = tmp_path / "run.gif"
    code, _, _ = invoke(
        *("show", str(run), "-o", str(file), "--duration", "0.5"),
        *("--width", "96", "--height", "72", "--camera", "follow"),
    )
    assert code == 0
    assert image.open(file).n_frames == 6


def test_a_folder_without_a_run_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="has no configuration"):
        load_run(tmp_path)
    code, out, err = invoke("show", str(tmp_path))
    assert code == 2 and out == "" and err.count("\n") == 1
