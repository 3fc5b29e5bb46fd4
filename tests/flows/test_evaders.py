"""Strategies of one's own: a file, an object, a network; and their rating."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flows import calls
from flows.own_strategies import FILE, HalfBack

ASIDE = "evasion(safety_radius=100)"

SPEED = 0.1  # [m/s], of unicycles and of NAO's template
STRIDE, STEP = 0.04, 0.547  # [m], [s], of NAO


def own(name: str) -> str:
    return f"{FILE}:{name}"


def network(
    file: Path,
    weights: Sequence[Sequence[float]],
    bias: Sequence[float],
    headings: list[float | None],
) -> Path:
    """Write an evader with one linear layer of distance and bearing."""
    onnx = pytest.importorskip("onnx")
    helper, real = onnx.helper, onnx.TensorProto.FLOAT
    rows, columns = np.shape(weights)
    model = helper.make_model(
        helper.make_graph(
            [helper.make_node("Gemm", ["seen", "w", "b"], ["wanted"])],
            "evader",
            [helper.make_tensor_value_info("seen", real, ["n", rows])],
            [helper.make_tensor_value_info("wanted", real, ["n", columns])],
            [
                onnx.numpy_helper.from_array(
                    np.array(weights, np.float32), "w"
                ),
                onnx.numpy_helper.from_array(np.array(bias, np.float32), "b"),
            ],
        ),
        opset_imports=[helper.make_opsetid("", 17)],
        ir_version=9,
    )
    entries = {
        "stepaside_strategy": "1",
        "direction": "backward",
        "observation_names": json.dumps(["distance", "bearing"]),
        "action_headings": json.dumps(headings),
    }
    helper.set_model_props(model, entries)
    onnx.save(model, file)
    return file


def steps_of(
    evader: object, steps: int, offsets: tuple[float, float] = (0.0, 0.0)
) -> Any:
    """Play a number of steps of unicycles that are 1 m apart at first."""
    return calls.duel_of(
        evader,
        distance=1.0,
        duration=steps * STEP,
        level="steps",
        offsets=offsets,
    )


def test_an_own_file_plays_as_a_unicycle() -> None:
    """Straight away at half the speed, so the gap closes at the other."""
    game = steps_of(own("HalfBack"), 15)
    expected = 1.0 - 0.5 * 15 * STRIDE
    assert game["min_distance_m"] == pytest.approx(expected, abs=1e-6)


def test_an_own_file_remembers_what_it_returns() -> None:
    """After five decisions it stands, and the pursuer comes on."""
    game = steps_of(own("FiveSteps"), 15)
    expected = 1.0 - STRIDE * (15 - 5)
    assert game["min_distance_m"] == pytest.approx(expected, abs=1e-6)


def test_an_own_object_plays_what_its_file_plays() -> None:
    """As a humanoid, which makes steps of half the stride."""
    run = calls.own_duel(HalfBack(), distance=1.0, duration=6.0)
    found = calls.duel_of(own("HalfBack"), distance=1.0, duration=6.0)
    assert found["min_distance_m"] == run.summary.min_distance_m
    assert found["distance_m"] == run.summary.distance_m
    paths = [
        np.hypot(*(track.torso[-1, :2] - track.torso[0, :2]))
        for track in (run.pursuer, run.evader)
    ]
    steps = (6.0 - 0.8) / STEP  # less the start on both feet
    assert paths[0] == pytest.approx(steps * STRIDE, abs=0.05)
    assert paths[1] == pytest.approx(0.5 * steps * STRIDE, abs=0.03)
    x, y = run.evader.torso[-1, :2] - run.evader.torso[0, :2]
    assert x > 0.1 and abs(y) < 0.06  # away from the pursuer, at the origin


def test_a_network_chooses_among_headings(tmp_path: Path) -> None:
    """It stands until 0.8 m, which are 1.6 v/k, and backs off from then."""
    unit = SPEED / 0.2
    file = network(
        tmp_path / "wary.onnx",
        [[-1.0, 0.0], [0.0, 0.0], [0.0, 0.0]],
        [0.8 / unit, 0.0],
        [0.0, None],
    )
    game = steps_of(file, 30)
    assert 0.8 - STRIDE - 1e-6 <= game["min_distance_m"] <= 0.8 + 1e-9
    assert game["distance_m"] == pytest.approx(game["min_distance_m"])


def test_a_network_of_two_outputs_is_the_file_of_the_same_law(
    tmp_path: Path,
) -> None:
    """Heading by the sine of the bearing, half the speed; the third input."""
    file = network(
        tmp_path / "half.onnx",
        [[0.0, 0.0], [0.0, 0.0], [1.0, 0.0]],
        [0.0, 0.5],
        [],
    )
    learned = steps_of(file, 15, (-0.6, 1.2))
    written = steps_of(own("HalfBack"), 15, (-0.6, 1.2))
    for key in ("min_distance_m", "distance_m", "relative_orientation_deg"):
        assert learned[key] == pytest.approx(written[key], abs=1e-3)
    # Not the straight one.
    assert abs(learned["min_distance_m"] - 0.7) > 0.01


def test_a_rating_compares_by_the_same_games() -> None:
    """Who stands is caught; the best possible is that of the starts."""
    evaders = calls.changes(evader=[own("Still"), ASIDE], seed="0:2")
    card = calls.rows_of("rating", *evaders)
    rows = {(r["evader"], r["floor"], r["pursuer"]): r for r in card}
    caught = rows[own("Still"), "open floor", "pursuit"]
    assert caught["survived"]["share"] == 0.0
    assert 0.35 - STRIDE <= caught["reached_m"]["mean"] <= 0.35
    assert caught["regret_m"]["mean"] > 0.5
    for (_, floor, pursuer), row in rows.items():
        other = rows[ASIDE, floor, pursuer]
        assert best_of(row) == pytest.approx(best_of(other))
    scores = calls.rows_of("rating", *evaders, "--by", "evader")
    assert [score["evader"] for score in scores] == [own("Still"), ASIDE]
    assert scores[0]["reached_m"]["mean"] < scores[1]["reached_m"]["mean"]
    for score in scores:
        reached = [
            row["reached_m"]["mean"]
            for row in card
            if row["evader"] == score["evader"]
        ]
        assert score["reached_m"]["mean"] == pytest.approx(np.mean(reached))


def best_of(row: dict[str, Any]) -> float:
    """Best possible closest approach: what is reached, and the regret."""
    return float(row["reached_m"]["mean"] + row["regret_m"]["mean"])
