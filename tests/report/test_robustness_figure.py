"""Figures of a campaign: the axes hold what the rows say."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.report import figure_style as style
from stepaside.report.robustness_figure import draw_limits, draw_survival


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Figures that were made, kept open to be read."""
    figures: list[Any] = []
    begin = style.new_figure

    def keep(width: float, height: float) -> Any:
        figures.append(begin(width, height))
        return figures[-1]

    monkeypatch.setattr(style, "new_figure", keep)
    monkeypatch.setattr(style.plt, "close", lambda figure: None)
    return figures


def survival(kind: str, method: str, strength: float, survived: int) -> Any:
    return {
        "kind": kind,
        "direction": "left" if kind == "push" else "",
        "method": method,
        "strength": strength,
        "survived": survived,
        "trials": 4,
        "low": 0.1 * survived,
        "high": 0.2 * survived,
    }


def limit(method: str, direction: str, phase: float, x: float) -> Any:
    return {
        "method": method,
        "direction": direction,
        "phase": phase,
        "limit_n_s": x,
        "bound_n_s": 2.0 + phase,
        "impulse_bound_n_s": 1.0 + phase,
    }


def lines_of(axis: Any) -> dict[str, Any]:
    return {line.get_label(): line for line in axis.get_lines()}


def test_survival_is_drawn_in_percent_over_strength(
    drawn: list[Any], tmp_path: Path
) -> None:
    rows = [
        survival("backlash", "mpc", 2.0, 1),
        survival("backlash", "mpc", 1.0, 3),
        survival("backlash", "measured", 1.0, 4),
        survival("push", "mpc", 0.4, 2),
    ]
    file = tmp_path / "survival.png"
    draw_survival(rows, {"backlash": "deg", "push": "N s"}, file)
    assert file.read_bytes()[:4] == b"\x89PNG"
    backlash, push = drawn[0].axes
    assert (backlash.get_title(), push.get_title()) == (
        "backlash",
        "push to the left",
    )
    assert backlash.get_xlabel() == "backlash [deg]"
    lines = lines_of(backlash)
    assert set(lines) == {
        "mpc, 4 trials per point",
        "measured, 4 trials per point",
    }
    np.testing.assert_allclose(
        lines["mpc, 4 trials per point"].get_xydata(),
        [[1.0, 75.0], [2.0, 25.0]],
    )
    band = backlash.collections[0].get_paths()[0].vertices
    assert {(1.0, 30.0), (1.0, 60.0), (2.0, 10.0), (2.0, 20.0)} <= {
        (round(x, 9), round(y, 9)) for x, y in band.tolist()
    }


def test_one_trial_per_point_is_an_outcome_and_no_share(
    drawn: list[Any], tmp_path: Path
) -> None:
    rows = [
        survival("friction", "measured", x, int(x < 2.0)) | {"trials": 1}
        for x in (1.0, 1.5, 2.0)
    ]
    draw_survival(rows, {"friction": "1"}, tmp_path / "survival.png")
    (axis,) = drawn[0].axes
    (line,) = axis.get_lines()
    assert line.get_label() == "measured, 1 trial per point"
    assert line.get_linestyle() == "None" and not axis.collections
    ticks = [text.get_text() for text in axis.get_yticklabels()]
    assert ticks == ["fell", "survived"]
    np.testing.assert_allclose(line.get_ydata(), [100.0, 100.0, 0.0])
    assert "[%]" not in axis.get_ylabel()


def test_limits_are_drawn_over_the_phase_beside_the_bound(
    drawn: list[Any], tmp_path: Path
) -> None:
    """The bound too where a method is known at some phases only."""
    rows = [
        limit("mpc", "left", 0.5, 1.1),
        limit("mpc", "left", 0.0, 0.9),
        limit("measured", "left", 0.0, 1.3),
        limit("mpc", "right", 0.0, 0.7),
        limit("mpc", "right", 1.0, 0.7),  # with the highest bound
    ]
    draw_limits(rows, tmp_path / "limits.png")
    left, right = drawn[0].axes
    assert (left.get_title(), right.get_title()) == (
        "push to the left",
        "push to the right",
    )
    lines = lines_of(left)
    np.testing.assert_allclose(
        lines["mpc"].get_xydata(), [[0.0, 0.9], [0.5, 1.1]]
    )
    np.testing.assert_allclose(lines["measured"].get_xydata(), [[0.0, 1.3]])
    np.testing.assert_allclose(
        lines["pendulum's bound"].get_xydata(), [[0.0, 2.0], [0.5, 2.5]]
    )
    np.testing.assert_allclose(
        lines["bound for an impulse at mid-push"].get_xydata(),
        [[0.0, 1.0], [0.5, 1.5]],
    )
    assert left.get_ylim()[0] == 0.0 and left.get_ylim()[1] > 3.0
    assert lines_of(right)["mpc"].get_ydata() == pytest.approx([0.7, 0.7])
