"""Tables of studies: a line for each row of each result."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from stepaside.studies.tabulation import LEAST_SPREAD

from .markdown import NONE, counted, interval, number, table

Result = Mapping[str, Any]
LABEL = "label"  # path to what tells a result from the others of a table


class Column(NamedTuple):
    """Column of a table.

    Attributes:
        head: Header.
        path: Name of a value of a row, and of one of its statistics after a
            slash, or of both ends of its range.
        digits: Decimals.
        factor: Converts the unit.
    """

    head: str
    path: str
    digits: int = 2
    factor: float = 1.0

    def cell(self, result: Result, row: Mapping[str, Any]) -> str:
        """Return the text of this column in a row."""
        name, _, which = self.path.partition("/")
        if name == LABEL:
            return str(result["settings"][LABEL])
        found = row[name]
        if found is None:
            return NONE
        if which == "range":
            return interval(found["min"], found["max"], self.digits)
        if which and "mean" not in found:  # a text: how often it occurred
            count = found[which]["count"] if which in found else 0
            return counted(count, row["number"])
        value = found[which] if which else found
        if isinstance(value, dict):
            if "mean" in value:
                text = f"{value['mean']:.{self.digits}f}"
                if value["number"] >= LEAST_SPREAD:
                    text += f" ± {value['half']:.{self.digits}f}"
                return text
            ends = interval(100 * value["low"], 100 * value["high"], 0)
            return f"{value['count']} ({ends} %)"
        if isinstance(value, float):
            return number(self.factor * value, self.digits)
        return str(value)


def of_columns(*columns: Column) -> Callable[..., str]:
    """Return the function that makes a table of results."""

    def make(*results: Result) -> str:
        return table(
            [column.head for column in columns],
            [
                [column.cell(result, row) for column in columns]
                for result in results
                for row in result["rows"]
            ],
        )

    return make


def commands(*results: Result) -> str:
    """Return the commands that made results, and their version."""
    versions = sorted({result["results"] for result in results})
    lines = [f"# results version {', '.join(versions)}"]
    lines += [result["command"] for result in results]
    return "\n".join(["```sh", *lines, "```"])


N = Column("n", "number")
TOUCHED, FELL = Column("touched", "contact"), Column("fell", "fell")
CLOSEST = Column("closest [m]", "closest_m/min")
MEAN = Column("mean [m]", "closest_m/mean")
BEGUN = Column("begun at [m]", "triggered_at_distance_m/mean", 1)
SPEED = Column("speed [m/s]", "speed", 1)

TABLES = {
    "commands": commands,
    "outcomes": of_columns(
        Column("body", LABEL),
        Column("duels", "number"),
        Column("played to the end", "outcome/completed"),
        Column("on the circle for the last 5 s", "on_circle"),
        Column("before the last third", "on_circle_in_time"),
    ),
    "certified": of_columns(
        Column("body", LABEL),
        Column("duels", "number"),
        Column("starts certified", "over_certificate_m/number"),
        Column("nearer than certified", "nearer_than_certified"),
        Column("median excess [m]", "over_certificate_m/median", 3),
        Column("least excess [m]", "over_certificate_m/min", 3),
    ),
    "camera-errors": of_columns(
        Column("duels", "number"),
        Column("setting", LABEL),
        Column("played to the end", "outcome/completed"),
        Column("distance on the circle [m]", "distance_m/range", 3),
        Column(
            "pursuer's bearing, median error [°]",
            "players.pursuer.sight.bearing_error_median_deg/mean",
        ),
        Column(
            "evader's bearing [°]",
            "players.evader.sight.bearing_error_median_deg/mean",
        ),
        Column(
            "evader's distance [mm]",
            "players.evader.sight.distance_error_median_m/mean",
            0,
            1e3,
        ),
        Column("false detections", "sight.false_detections/max", 0),
    ),
    "people": of_columns(SPEED, N, TOUCHED, FELL, CLOSEST, MEAN, BEGUN),
    "people-of": of_columns(
        Column("robot", LABEL), SPEED, N, TOUCHED, FELL, CLOSEST, BEGUN
    ),
    "people-seen": of_columns(
        Column("sight, body, speed", LABEL),
        Column("from [°]", "bearing", 0),
        *(N, TOUCHED, FELL, CLOSEST, MEAN, BEGUN),
    ),
    "people-reactions": of_columns(
        Column("reaction", "person"),
        *(N, TOUCHED, FELL, CLOSEST),
        Column("median [m]", "closest_m/median"),
    ),
    "person-walks": of_columns(
        Column("walk", "walk"),
        N,
        Column("touched", "outcome/contact"),
        Column("fell", "outcome/fall"),
        Column("triggered at [m]", "triggered_at_distance_m/range"),
        Column("closest [m]", "min_distance_m/range"),
        Column("theory [m]", "theory.min_distance_m/range"),
    ),
    "chases": of_columns(
        Column("turning radius [m]", "person.turning_radius", 1),
        Column("chases", "number"),
        Column("fell", "outcome/fall"),
        Column("closest [m]", "min_distance_m/min"),
        Column("median [m]", "min_distance_m/median"),
    ),
    "crowds": of_columns(
        Column("robot", LABEL),
        Column("games", "number"),
        Column("success", "robot.success"),
        Column("collided", "robot.collided"),
        FELL,
        Column("time to the goal [s]", "robot.time_s/mean", 1),
        Column("below 0.45 m [%]", "robot.intimate_share/mean", 1, 100.0),
        Column("below 1.2 m [%]", "robot.personal_share/mean", 0, 100.0),
    ),
    "push-methods": of_columns(
        Column("gait", LABEL),
        Column("method", "method"),
        N,
        Column("of the bound, median", "of_bound/median"),
        Column("least", "of_bound/min"),
        Column("most", "of_bound/max"),
        Column("above it", "above_bound"),
        Column("least push [N s]", "limit_n_s/min", 1),
    ),
    "rooms": of_columns(
        Column("pursuer", "pursuer.strategy"),
        Column("evader", "evader.strategy"),
        Column("map", "map.source"),
        Column("duels", "number"),
        Column("nothing touched", "outcome/completed"),
        Column("captured", "captured_at_s/number"),
        Column("contact", "outcome/contact"),
        Column("fell", "outcome/fall"),
        Column("time played [s]", "duration_s/mean", 0),
        Column("closest [m]", "min_distance_m/range"),
    ),
    "teams": of_columns(
        Column("pursuers", "pursuers"),
        Column("evaders", "evaders"),
        Column("games", "number"),
        Column("captured", "captured"),
        Column("mean closest [m]", "closest_m/mean", 3),
        Column("closest [m]", "closest_m/min", 3),
    ),
    "evaders": of_columns(
        Column("evader", "evader"),
        Column("games", "number"),
        Column("score [m]", "reached_m", 3),
        Column("survived", "survived"),
    ),
    "pursuers": of_columns(
        Column("pursuer", "pursuer"),
        Column("games", "number"),
        Column("evader's closest approach [m]", "reached_m", 3),
        Column("captured", "captured"),
    ),
}
"""Tables of studies by name."""
