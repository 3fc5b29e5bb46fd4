"""Test how documents are made, on small ones."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.sim.body_settings import BODIES
from stepaside.studies.result_files import header, write_result
from tools.documents.__main__ import old_results
from tools.documents.blocks import BLOCK, make
from tools.documents.document import complaints, remade
from tools.documents.numbers import show
from tools.documents.pictures import PICTURES, draw_picture, drawn_from
from tools.documents.store import ROOT, DocumentError, Store
from tools.documents.tables import TABLES
from tools.documents.tables.markdown import counted, interval, number, table

FOUND: dict[str, Any] = {
    "ratio": 0.98765,
    "loss": -0.00456,
    "starts": 4000,
    "falls": 0,
    "by": {"0": {"falls": 9}, "0.8": {"falls": 2}},
    "list": [1.5, 2.5],
    "word": "none",
    "truth": True,
    "printed": "a  1\n",
}


@pytest.fixture
def store(tmp_path: Path) -> Store:
    write_result(tmp_path / "run.json", header({}, command="none"), **FOUND)
    return Store(tmp_path)


@pytest.mark.parametrize(
    ("old", "mark", "new"),
    [
        ("0.500", "ratio", "0.988"),
        ("1", "ratio * 100", "99"),
        ("1.0", "list.1 / 2", "1.2"),
        ("9,999", "starts", "4,000"),
        ("-1.0", "loss * 1000", "-4.6"),
        ("−1.0", "loss * 1000", "−4.6"),
        ("+1.00", "ratio", "+0.99"),
        ("no", "falls", "no"),
        ("No", "by.0.8.falls", "2"),
        ("3", "falls", "0"),
    ],
)
def test_a_marked_number_becomes_that_of_the_result(
    store: Store, old: str, mark: str, new: str
) -> None:
    text = f"| It is {old}<!--= run:{mark}--> m |"
    assert remade(text, store) == f"| It is {new}<!--= run:{mark}--> m |"


def test_a_range_is_two_numbers_and_not_a_minus(store: Store) -> None:
    text = "0.1<!--= run:list.0-->-0.2<!--= run:list.1--> m"
    wanted = "1.5<!--= run:list.0-->-2.5<!--= run:list.1--> m"
    assert remade(text, store) == wanted


def test_what_is_not_marked_stays(store: Store) -> None:
    text = "A <!-- note --> 0.5 of 3\n\n| 1 |\n|---|\n"
    assert remade(text, store) == text


def test_remaking_twice_changes_nothing_more(store: Store) -> None:
    text = "1.0<!--= run:ratio-->\n<!-- made: run.printed -->\nold\n"
    once = remade(f"{text}<!-- /made -->\n", store)
    assert "```\na  1\n```" in once and "old" not in once
    assert remade(once, store) == once


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("0.98<!--= run:ratio-->", "2: wanted '0.99', got '0.98' (run:ratio)"),
        ("1<!--= run:raito-->", "2: run:raito: no 'raito' among command"),
        ("1<!--= run:list.2-->", "2: run:list.2: no '2' among 2 entries"),
        ("1<!--= run:word-->", "2: run:word is no number, got 'none'"),
        ("1<!--= run:truth-->", "2: run:truth is no number, got True"),
        ("1<!--= other:ratio-->", "2: no result other.json"),
        ("one<!--= run:ratio-->", "2: a mark must follow a number"),
        ("1<!--= run:ratio +-->", "2: a mark must read <!--= name:path"),
        (
            "<!-- made: run.nothing -->\n<!-- /made -->",
            "3: no table 'nothing'",
        ),
        ("<!-- made: run.rms -->\n<!-- /made -->", "3: run does not hold"),
        ("<!-- made: run.printed -->\n", "2: a block must read"),
        ("<!-- /made -->", "2: a block must read"),
        (
            "<!-- made: run.printed -->\n\n```\na  2\n```\n\n<!-- /made -->",
            "5: wanted 'a  1', got 'a  2' (run.printed)",
        ),
    ],
)
def test_a_complaint_names_line_wanted_and_got(
    store: Store, tmp_path: Path, line: str, complaint: str
) -> None:
    file = tmp_path / "page.md"
    file.write_text(f"# Page\n{line}\n", encoding="utf-8")
    found = complaints(file, store)
    assert len(found) == 1
    assert found[0].startswith(f"page.md:{complaint}")


def test_a_page_that_is_right_has_no_complaints(
    store: Store, tmp_path: Path
) -> None:
    file = tmp_path / "page.md"
    file.write_text("0.99<!--= run:ratio-->\n", encoding="utf-8")
    assert complaints(file, store) == []


def test_numbers_inside_a_block_belong_to_the_block(
    store: Store, tmp_path: Path
) -> None:
    file = tmp_path / "page.md"
    file.write_text(
        "<!-- made: run.printed -->\n3<!--= run:starts-->\n<!-- /made -->\n"
    )
    assert len(complaints(file, store)) == 1
    made = "<!-- made: run.printed -->\n\n```\na  1\n```\n\n<!-- /made -->\n"
    assert remade(file.read_text(), store) == made


def test_parts_of_other_lengths_are_all_put_in_their_places(
    store: Store,
) -> None:
    text = "1<!--= run:starts--> of 2<!--= run:starts--> and no more"
    assert remade(text, store).split("<!--= run:starts-->") == [
        "4000",
        " of 4000",
        " and no more",
    ]


def test_zero_stays_a_word_only_while_it_is_zero() -> None:
    assert show(0, "no") == "no"
    assert show(1, "no") == "1"


def test_a_table_refuses_a_row_that_does_not_fit() -> None:
    assert table(("a", "b"), [("1", "2")]).splitlines()[1] == "|---|---|"
    with pytest.raises(ValueError, match="want 2 cells"):
        table(("a", "b"), [("1",)])


def test_an_interval_without_width_is_one_number() -> None:
    assert interval(0.5, 0.75, 2) == "0.50-0.75"
    assert interval(0.5, 0.5001, 2) == "0.50"
    assert number(None) == "-"


def test_a_picture_is_drawn_again_only_when_results_change(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = [
        {"method": "mpc", "direction": "left", "phase": phase}
        | {"limit_n_s": 1.0, "bound_n_s": 2.0, "impulse_bound_n_s": 2.5}
        for phase in (0.0, 0.5)
    ]
    head = header({}, command="none")
    write_result(tmp_path / "pushes.json", head, rows=rows)
    name = "push-limits.png"
    assert draw_picture(name, Store(tmp_path), tmp_path)
    assert not draw_picture(name, Store(tmp_path), tmp_path)
    assert drawn_from(tmp_path / name).startswith("pushes.json ")
    rows[0]["limit_n_s"] = 1.5
    write_result(tmp_path / "pushes.json", head, rows=rows)
    store = Store(tmp_path)
    assert drawn_from(tmp_path / name) != PICTURES[name].source(store)
    assert draw_picture(name, store, tmp_path)
    assert drawn_from(tmp_path / name) == PICTURES[name].source(store)
    assert sorted(f.suffix for f in tmp_path.iterdir()) == [".json", ".png"]


def test_the_figure_of_the_duel_is_drawn_from_its_tracks() -> None:
    """The committed tracks are those of the committed summary."""
    store = Store()
    result = store.result("duel-seed7")
    with np.load(store.folder / result["trajectories"]["file"]) as tracks:
        apart = tracks["evader_place"] - tracks["pursuer_place"]
        times = tracks["times_s"]
    last = times >= times[-1] * 2.0 / 3.0
    distance = np.hypot(apart[last, 0], apart[last, 1]).mean()
    assert distance == pytest.approx(result["summary"]["distance_m"], abs=2e-4)


def test_the_store_reads_a_file_once(store: Store) -> None:
    first = store.result("run")
    (store.folder / "run.json").write_text(json.dumps({}))
    assert store.result("run") is first
    with pytest.raises(DocumentError, match="lacks command"):
        Store(store.folder).result("run")


def test_many_duels_become_tables(tmp_path: Path) -> None:
    share = {"number": 2, "of": 3, "low": 0.2, "high": 0.94}
    figure = {
        **{"theory": 0.9, "mean": 0.91, "mean_low": 0.9, "mean_high": 0.92},
        **{"least": 0.85, "greatest": 1.0, "worst": 1.0, "worst_seed": 12},
    }
    certificate = {
        **{"certified": share, "nearer_than_certified": share},
        **{"median_excess_m": 0.1, "least_excess_m": -0.02, "worst_seed": 7},
    }
    write_result(
        tmp_path / "duels-hardware.json",
        header({"seeds": [0, 3]}, command="none"),
        summary={
            "duels": 3,
            "outcomes": {"completed": share},
            "on_the_circle": share,
            "on_the_circle_in_time": share | {"number": 1},
            "figures": {"distance_m": figure},
            "certificate": certificate,
        },
    )
    store = Store(tmp_path)
    two = "2 of 3 (20.0-94.0 %)"
    assert make("all", "outcomes", store).splitlines()[2:] == [
        f"| hardware-like | 0:3 | 3 | {two} | {two} | 1 of 3 (20.0-94.0 %) |"
    ]
    assert make("duels-hardware", "spreads", store).splitlines()[2:] == [
        "| distance [m] | 0.900 | 0.910 | 0.900-0.920 | 0.850 | 1.000 |"
    ]
    assert make("all", "worst-seeds", store).splitlines()[2:] == [
        "| hardware-like | distance [m] | 1.000 | "
        "`stepaside duel --seed 12 --body hardware` |"
    ]
    assert make("all", "certified", store).splitlines()[2:] == [
        f"| hardware-like | {two} | {two} | 0.100 | -0.020 | 7 |"
    ]


def test_counts_of_people_have_intervals() -> None:
    """0 of 15 allows 20 %, and no table of people hides it."""
    assert counted(0, 15) == "0 (0-20 %)"
    assert counted(15, 15) == "15 (80-100 %)"
    row = {
        **{"body": "ideal", "sensing": "ideal", "speed_m_s": 1.0},
        **{"miss_m": 0.0, "number": 15, "contacts": 0, "falls": 3},
        **{"begun": 15, "begun_at_m": 2.0, "closest_m": 0.5},
        **{"mean_closest_m": 0.6, "template_closest_m": 0.6, "from": "ahead"},
        **{"triggered_at_m": 2.0, "theory_room_m": 0.3, "false_triggers": 0},
        **{"false_triggers_per_hour": 0.0},
    }
    result = {
        "settings": {"body": "ideal", "speed_m_s": 1.0},
        **{"people": [row], "passers_by": [row], "rows": [row]},
        **{"came": [row], "passed": row},
    }
    for name in ("people", "passers-by", "people-seen", "people-fast-gait"):
        assert counted(0, 15) in TABLES[name](result)
    assert TABLES["people-passed-by"](result).count(counted(0, 15)) == 2
    for name in ("people", "people-seen", "people-fast-gait"):
        assert counted(3, 15) in TABLES[name](result)


def test_people_around_learned_legs_are_counted_by_body() -> None:
    backlash = BODIES["hardware"].backlash
    body = {"cycle": 0.012, "delay_cycles": 1, "backlash": backlash}
    row = {
        **{"speed_m_s": 1.4, "number": 12, "contacts": 1, "falls": 2},
        **{"closest_m": 0.5, "mean_closest_m": 0.6, "triggered_at_m": None},
        **{"template_closest_m": 0.7, "false_triggers": 3},
    }
    ideal = {"body": "ideal", "changes": "{}", "sensings": ["ideal"]}
    changed = json.dumps({"body": body})
    plain = {"settings": ideal}
    own = {"settings": ideal | {"body": "own", "changes": changed}}
    rows = {"people": [row], "passers_by": [row]}
    moved = json.dumps({"body": body, "robot": "t1"})
    sees = {"changes": moved, "sensings": ["lidar"]}
    seeing = {"settings": ideal | sees}
    both = {"sensings": ["cameras"], "rear_camera": True}
    behind = {"settings": ideal | sees | both}
    results = plain | rows, own | rows, seeing | rows, behind | rows
    for name in ("legs-people", "legs-passers-by"):
        made = TABLES[name](*results).splitlines()
        assert made[2].startswith("| ideal |")
        assert made[3].startswith("| hardware, delay 12 ms |")
        assert counted(1, 12) in made[3]
        assert made[4].startswith("| hardware, delay 12 ms, T1 with lidar |")
        assert ", T1 with cameras ahead and behind |" in made[5]
    chases = [
        {
            **{"turning_radius_m": 4.0, "feints": False, "outcome": outcome},
            **{"closest_m": closest, "template_closest_m": 0.5},
        }
        for outcome, closest in (("fall", 0.45), ("completed", 0.75))
    ]
    found = {
        "settings": {"robot": "g1", "sensing": "ideal"},
        **{"closed_form_m": {"4": 0.51}, "chases": chases},
    }
    made = TABLES["legs-chasers"](found).splitlines()
    assert made[2].startswith(
        "| G1 | ideal | steers | 4 | 0.51 | 0.50 (0.50) | 0.60 (0.45) "
        "| 1.20 (0.90) |"
    )
    assert counted(1, 2) in made[2]


@pytest.mark.parametrize("page", ["evading", "obstacles", "learning"])
def test_every_figure_of_survival_names_the_pursuer(page: str) -> None:
    """A share survived holds against one pursuer, so no table goes without."""
    store, seen = Store(), 0
    text = (ROOT / "docs" / f"{page}.md").read_text("utf-8")
    for match in BLOCK.finditer(text):
        if match["table"] in ("map-decisions", "environments"):
            continue
        head = make(match["names"], match["table"], store).splitlines()[0]
        named = any(word in head for word in ("pursuer", "against", "pure"))
        assert named, match["source"]
        seen += 1
    assert seen


def test_starts_that_must_be_survived_stand_beside_the_others() -> None:
    row = {"pursuer": "sharp", "evader": "robust", "sure": 7, "open": 0}
    row |= {"sure_survived": 6, "open_survived": 0}
    made = TABLES["open-floor"]({"rows": [row]}, {"rows": [row]}).splitlines()
    assert made[2] == made[3] == "| sharp | robust | 7 | 6 | 0 | - |"


def test_opponents_stand_beside_circle_capture_and_interval() -> None:
    row = {
        **{"pursuer": "pure-x2.8", "games": 50, "survived": 0.5},
        **{"survived_low": 0.366, "survived_high": 0.634},
        **{"circle_distance_m": 0.34706, "capture_distance_m": 0.35},
    }
    met = {"world": "open floor", "evader": "aside", "rows": [row]}
    assert TABLES["evading-opponents"]({"opponents": [met]}).splitlines() == [
        "| pursuer | circle [m] | capture [m] | aside, open floor (n = 50) |",
        "|---|---|---|---|",
        "| pure-x2.8 | 0.347 | 0.350 | 50 % (37-63) |",
    ]


def test_choices_of_heading_and_point_become_means(tmp_path: Path) -> None:
    rows = [
        {"heading": "both feet", "point": "torso", "seed": seed}
        | {"pursuer_radius_m": 0.6, "evader_radius_m": 0.7}
        | {"distance_m": d, "torsos_apart_m": d - 0.02}
        for seed, d in enumerate([0.8, 1.0])
    ]
    head = header({}, command="none")
    write_result(tmp_path / "sight-definitions.json", head, rows=rows)
    assert make(
        "sight-definitions", "sight-definitions", Store(tmp_path)
    ).endswith("| both feet | torso | 2 | 0.600 | 0.700 | 0.900 | 0.880 |")


def test_all_results_stand_in_the_index(store: Store) -> None:
    row = make("all", "index", store).splitlines()[2]
    assert row.startswith("| [run](run.json) | `none` | ")


def test_results_of_other_code_are_told_with_what_renews_them(
    tmp_path: Path,
) -> None:
    now = header({}, modules=("core/errors",), command="make now")
    others = {
        "changed": now | {"version": "0" * 12, "command": "make changed"},
        "moved": now | {"modules": ["cellar"], "command": "make moved"},
    }
    for name, head in {"new": now, **others}.items():
        write_result(tmp_path / f"{name}.json", head)
    assert old_results(Store(tmp_path)) == [
        f"{name}: made with other code; again by: make {name}"
        for name in others
    ]
