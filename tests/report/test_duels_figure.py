"""Figure of many duels, read back from its axes."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from stepaside.report.duels_figure import PANELS, draw_duels
from stepaside.report.figure_style import RIGHT, THEORY, plt

KEYS = [key for keys, _ in PANELS for key in keys]
SUMMARY = {
    "figures": {
        "pursuer_radius_m": {"theory": 0.6},
        "evader_radius_m": {"theory": 0.6},
        "distance_m": {"theory": 0.9},
    }
}


def record(value: float | None) -> dict[str, Any]:
    """Duel whose figures are all the same."""
    return {"outcome": "completed"} | dict.fromkeys(KEYS, value)


@pytest.fixture
def kept(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Iterator[list[Figure]]:
    """Figures that were drawn, instead of files."""
    monkeypatch.chdir(tmp_path)
    figures: list[Figure] = []
    monkeypatch.setattr(
        Figure, "savefig", lambda f, *_, **__: figures.append(f)
    )
    real = plt.close
    monkeypatch.setattr(plt, "close", lambda _: None)
    yield figures
    for figure in figures:
        real(figure)


def panels(
    kept: list[Figure], *groups: Sequence[dict[str, Any]]
) -> list[list[Any]]:
    """Axes, a row for each group."""
    named = {f"g{i}": group for i, group in enumerate(groups)}
    draw_duels(named, SUMMARY, Path("figure.png"))
    axes, width = kept[-1].axes, len(PANELS)
    return [axes[i : i + width] for i in range(0, len(axes), width)]


def legend(figure: Figure) -> dict[str, Any]:
    """Handles of the figure's legend, by label."""
    if not figure.legends:
        return {}
    (found,) = figure.legends
    texts = [text.get_text() for text in found.get_texts()]
    assert len(set(texts)) == len(texts)
    return dict(zip(texts, found.legend_handles, strict=True))


def test_each_line_is_in_the_legend_below_the_panels(
    kept: list[Figure],
) -> None:
    [(_, distance, *_)] = panels(kept, [record(0.8), record(1.2)])
    shown = legend(kept[-1])
    assert set(shown) == {"pursuer", "evader", "theory", "mean"}
    drawn = {
        float(one.get_xdata()[0]): (to_hex(one.get_color()), one)
        for one in distance.lines
    }
    assert sorted(drawn) == [0.9, pytest.approx(1.0)]
    for label, (_, (colour, one)), wanted in zip(
        ("theory", "mean"), sorted(drawn.items()), (THEORY, RIGHT), strict=True
    ):
        assert one.get_label() == label and colour == to_hex(wanted)
        handle = shown[label]
        assert to_hex(handle.get_color()) == colour
        assert handle.get_linestyle() == one.get_linestyle()


def test_no_panel_has_a_legend_on_its_data(kept: list[Figure]) -> None:
    for row in panels(kept, [record(0.8)], [record(0.9)]):
        assert not any(axis.get_legend() for axis in row)


def test_panels_without_figures_have_no_legend(kept: list[Figure]) -> None:
    """As where every duel ended before it could be measured."""
    [row] = panels(kept, [record(None)])
    assert not any(axis.lines for axis in row) and not legend(kept[-1])


def test_the_last_row_says_what_is_drawn_and_its_unit(
    kept: list[Figure],
) -> None:
    first, second = panels(kept, [record(0.8)], [record(0.9)])
    assert not any(axis.get_xlabel() for axis in first)
    labels = [axis.get_xlabel() for axis in second]
    assert len(set(labels)) == 5
    assert all(label.endswith("]") for label in labels)
