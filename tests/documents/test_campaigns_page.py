"""Test that the code of docs/campaigns.md runs."""

import re
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.studies import load_study, tournament
from stepaside.theory.value.two_cars import pursuit_bound

PAGE = (Path(__file__).parents[2] / "docs" / "campaigns.md").read_text("utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", PAGE, flags=re.DOTALL)


@pytest.mark.slow
def test_queries_of_a_tournament_run(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    pytest.importorskip("polars")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(tournament, "CELLS", 16)
    pursuit_bound.cache_clear()
    line = "study tournament --set seed=0:2 --set duration=5.47"
    words = [*line.split(), "--workers", "1", "--output", "games.sqlite"]
    answer = CliRunner().invoke(
        main, [*words, "--set", "evader=optimal,robust"]
    )
    pursuit_bound.cache_clear()
    assert answer.exit_code == 0, answer.output
    study, query = blocks("python")
    exec(compile(query, "docs/campaigns.md", "exec"), {})
    assert "robust" in capsys.readouterr().out
    exec(compile(study, "docs/campaigns.md", "exec"), {})


def test_the_study_file_is_one(tmp_path: Path) -> None:
    (text,) = blocks("toml")
    file = tmp_path / "radius.toml"
    file.write_text(text)
    assert tomllib.loads(text)["game"] == "duel"
    assert len(load_study(file).cases) == 3 * 2 * 40 * 2
