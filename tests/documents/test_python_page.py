"""Run the page on Python, block after block, as a reader would."""

import re
from pathlib import Path

import pytest

import stepaside

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_every_block_of_the_page_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    assert len(blocks) >= 8
    names: dict[str, object] = {"__name__": "page"}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
    assert (tmp_path / "duel.pdf").stat().st_size > 10_000
    assert (tmp_path / "kept.html").stat().st_size > 10_000
    phase = names["controller"].phase  # type: ignore[attr-defined]
    assert str(phase) == "Phase.WALKING"


def test_every_example_is_named_on_the_page() -> None:
    for file in (ROOT / "examples").glob("*.py"):
        assert f"examples/{file.name}" in PAGE, file.name


def test_every_name_at_the_door_is_there_and_no_other() -> None:
    for name in stepaside.__all__:
        assert getattr(stepaside, name) is not None
    assert dir(stepaside) == sorted(stepaside.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        getattr(stepaside, "nothing")  # noqa: B009
