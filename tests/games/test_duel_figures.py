"""Test that summaries of duels are written and read again."""

import json
from copy import deepcopy
from dataclasses import replace
from typing import Any

import pytest

from invented_run import figures
from stepaside.core.errors import ConfigurationError
from stepaside.games.duel_summary import (
    DuelSummary,
    PlanTimes,
    PlayerSummary,
    TheorySummary,
)
from stepaside.games.sight_summary import (
    ErrorSpread,
    PerceptionSummary,
    SightSummary,
)

BLIND = figures(
    seed=3,
    duration_s=20.0,
    triggered_at_s=2.5,
    triggered_at_distance_m=0.79,
    converged_at_s=11.0,
    replans=40,
    min_zmp_margin_m=0.021,
    theory=TheorySummary(None, True, 0.637, 0.9, 90.0),
    plan_time_us=PlanTimes(180.0, 300.0),
    pursuer=PlayerSummary(0.63),
    evader=PlayerSummary(0.64),
)
EYES = SightSummary(
    bearing_error_deg=ErrorSpread(0.7, None),
    distance_error_m=ErrorSpread(None, None),
    detection_rate=0.9,
    false_detections=2,
    misled_s=0.5,
    lost_s=0.0,
)
SEEING = figures(
    pursuer=PlayerSummary(0.63, EYES),
    evader=PlayerSummary(None, replace(EYES, depth_detection_rate=1.0)),
    sight=PerceptionSummary("raycast", 0.97, 4, 1.5),
    run_folder="/some/where",
)
WITH_A_PERSON = figures(
    pursuer=PlayerSummary(None), evader=PlayerSummary(0.6, EYES)
)


@pytest.mark.parametrize("told", [BLIND, SEEING, WITH_A_PERSON])
def test_a_summary_is_read_as_written(told: DuelSummary) -> None:
    """Through JSON text, too."""
    plain = told.to_json()
    assert DuelSummary.from_json(plain, "test") == told
    again = json.loads(json.dumps(plain))
    found = DuelSummary.from_json(again, "test")
    assert found == told
    assert json.dumps(found.to_json()) == json.dumps(plain)


def test_perception_entries_are_beside_the_others() -> None:
    plain = SEEING.to_json()
    assert plain["pursuer"] == {
        "radius_m": 0.63,
        "bearing_error_deg": {"median": 0.7, "p95": None},
        "distance_error_m": {"median": None, "p95": None},
        "detection_rate": 0.9,
        "false_detections": 2,
        "misled_s": 0.5,
        "lost_s": 0.0,
    }
    assert plain["evader"]["depth_detection_rate"] == 1.0
    assert plain["camera"] == "raycast" and plain["lost_s"] == 1.5
    assert "sight" not in plain and plain["run_folder"] == "/some/where"
    blind = BLIND.to_json()
    assert blind["evader"] == {"radius_m": 0.64}
    assert "run_folder" not in blind and "camera" not in blind


def test_conversion_to_json_does_not_change_a_summary() -> None:
    SEEING.to_json()["pursuer"]["lost_s"] = 9.0
    assert SEEING.pursuer.sight is not None
    assert SEEING.pursuer.sight.lost_s == 0.0
    plain = SEEING.to_json()
    before = deepcopy(plain)
    DuelSummary.from_json(plain, "test")
    assert plain == before


def test_integers_are_converted_to_floats_where_expected() -> None:
    plain = BLIND.to_json() | {"distance_m": 1, "triggered_at_s": 2}
    found = DuelSummary.from_json(plain, "test")
    assert isinstance(found.distance_m, float) and found.distance_m == 1.0
    assert isinstance(found.triggered_at_s, float)
    assert isinstance(found.replans, int)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"distance_m": "far"}, "distance_m"),
        ({"distance_m": None}, "distance_m"),
        ({"distance_m": True}, "float"),
        ({"replans": 1.5}, "replans"),
        ({"replans": True}, "int"),
        ({"seed": "one"}, "seed"),
        ({"message": 3}, "message"),
        ({"theory": None}, "theory"),
        ({"theory": [1.0]}, "theory"),
        ({"theory": {"radius_m": 1.0}}, "exists"),
        ({"plan_time_us": "fast"}, "plan_time_us"),
        ({"start": 1.0}, "start"),
        ({"pursuer": 0.6}, "pursuer"),
        ({"evader": {"radius_m": "wide"}}, "radius_m"),
        ({"evader": {"radius_m": 0.6, "lost_s": 1.0}}, "sight"),
        ({"camera": "raycast"}, "sight"),
    ],
)
def test_a_damaged_entry_is_refused_by_name(
    changes: dict[str, Any], word: str
) -> None:
    with pytest.raises(ConfigurationError) as refused:
        DuelSummary.from_json(BLIND.to_json() | changes, "summary.json")
    message = str(refused.value)
    assert message.startswith("summary.json: ") and word in message
    assert "\n" not in message


@pytest.mark.parametrize(
    "name",
    [
        *("outcome", "message", "seed", "duration_s", "start", "distance_m"),
        *("relative_orientation_deg", "min_distance_m", "replans", "theory"),
        *("max_com_velocity_jump_m_s", "plan_time_us", "real_time_factor"),
        *("pursuer", "evader"),
    ],
)
def test_a_required_entry_may_not_be_missing(name: str) -> None:
    plain = BLIND.to_json()
    del plain[name]
    with pytest.raises(ConfigurationError, match=f"^here: .*{name}"):
        DuelSummary.from_json(plain, "here")


@pytest.mark.parametrize("plain", [None, 3, "text", [BLIND.to_json()]])
def test_a_value_that_is_no_object_is_no_summary(plain: Any) -> None:
    with pytest.raises(ConfigurationError, match="here must hold one JSON"):
        DuelSummary.from_json(plain, "here")
