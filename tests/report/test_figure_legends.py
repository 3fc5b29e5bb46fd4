"""Every line and ring of a figure has a name that a legend shows."""

from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure

from stepaside.report import figure_style as style
from stepaside.report import people_figure, value_function_figure
from stepaside.theory.bound import Bound, Grid, solve_bound, two_car_game


@pytest.fixture
def kept(monkeypatch: pytest.MonkeyPatch) -> list[Figure]:
    """Figures that are written are kept."""
    figures: list[Figure] = []
    for module in (value_function_figure, people_figure):
        monkeypatch.setattr(module, "save", lambda f, _: figures.append(f))
    return figures


def names_of(figure: Any) -> str:
    """All that legends of a figure and its axes say."""
    legends = [*figure.legends, *(axes.get_legend() for axes in figure.axes)]
    return "; ".join(
        text.get_text()
        for legend in legends
        if legend is not None
        for text in legend.get_texts()
    )


@pytest.mark.parametrize("touched", [0, 2])
def test_people_have_their_ring_speeds_and_touches_named(
    kept: list[Figure], touched: int
) -> None:
    rows = [
        {
            "sensing": "cameras",
            "speed_m_s": speed,
            "bearing_deg": bearing,
            "closest_m": 0.8,
            "contacts": touched,
        }
        for speed in (0.3, 1.4)
        for bearing in (0.0, 90.0)
    ]
    people_figure.draw_people(rows, 0.7, Path("people.png"))
    told = names_of(kept[0])
    for name in ("desired clearance 0.7 m", "0.3 m/s", "1.4 m/s"):
        assert name in told
    assert ("contact" in told) == bool(touched)
    title = kept[0].axes[0].get_title()
    assert "[m]" in title and "cameras" in title and "ahead" in title
    style.plt.close("all")


def test_the_bound_s_lines_are_named(kept: list[Figure], bound: Bound) -> None:
    value_function_figure.draw_bound(bound, 0.4, "bound.png")
    told = names_of(kept[0])
    for name in ("capture distance 0.4 m", "certain", "pursuer's", "evader's"):
        assert name in told
    style.plt.close("all")


@pytest.fixture(scope="module")
def bound() -> Bound:
    """A coarse table of two identical cars."""
    game = two_car_game(1.0, 1.0, 1.0)
    return solve_bound(game, Grid(0.3, 6.0, 17, 16, 16))
