"""Printed tables of result entries."""

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from math import isfinite
from typing import TYPE_CHECKING, Any

from ..report.result_labels import in_unit, label_of, unit_of
from ..report.study_table import align_columns
from .terminal import echo

if TYPE_CHECKING:
    from ..games.run import Run
    from ..games.summary import Summary

Row = Mapping[str, Any]
MOST_PAIRS = 15  # that are all printed
ERRORS = ("tracking", "estimation")  # of a walk: only in JSON


def plain(value: Any) -> Any:
    """Return a result as JSON has it.

    Dataclasses and named tuples become objects, NaN and infinity null, and
    complex numbers pairs.
    """
    if is_dataclass(value) and not isinstance(value, type):
        value = {f.name: getattr(value, f.name) for f in fields(value)}
    elif hasattr(value, "_asdict"):
        value = value._asdict()
    if isinstance(value, Mapping):
        return {name: plain(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    if isinstance(value, complex):
        return [value.real, value.imag]
    if isinstance(value, float) and not isfinite(value):
        return None
    return value


def format_value(name: str, value: Any, digits: int = 6) -> str:
    """Return a value with the unit of its name.

    Args:
        name: Name of the value.
        value: Value in the unit of the name; a list has pairs of real and
            imaginary parts.
        digits: Number of significant digits.
    """
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    unit = unit_of(name)
    if isinstance(value, list):
        pairs = [f"{re:.{digits}g}{im:+.{digits}g}i" for re, im in value]
        text = ", ".join(pairs)
    elif isinstance(value, Mapping):
        text = ", ".join(f"{one} by {other}" for one, other in value.items())
        return text or "none"
    elif isinstance(value, int | float):
        text = _significant(in_unit(name, value), digits)
    else:
        return str(value)
    return f"{text} {unit}".strip()


def _significant(value: float, digits: int) -> str:
    """Return a number with that many digits; an integer and 0 as they are."""
    if isinstance(value, int) or not value:
        return f"{value:.0f}"
    return f"{value:#.{digits}g}".removesuffix(".")


def table_rows(
    result: Row, names: Iterable[str], digits: int = 6
) -> list[tuple[str, str]]:
    """Return labels and formatted values of some entries of a result."""
    return [
        (label_of(name), format_value(name, result[name], digits))
        for name in names
    ]


def result_rows(result: Row, digits: int = 4) -> list[tuple[str, str]]:
    """Return labels and values of all entries, of inner ones as well.

    Tables in lists are left out.
    """
    rows = []
    for name, value in result.items():
        if isinstance(value, Mapping):
            inner, unit = result_rows(value, digits), unit_of(name)
            rows += [
                (f"{label_of(name)}: {each}", f"{text} {unit}".strip())
                for each, text in inner
            ]
        elif not isinstance(value, list | tuple):
            rows.append((label_of(name), format_value(name, value, digits)))
        elif name.endswith("_per_s"):  # eigenvalues
            rows.append((label_of(name), format_value(name, value, digits)))
        elif not any(isinstance(each, Mapping | list) for each in value):
            texts = (format_value(name, each, digits) for each in value)
            rows.append((label_of(name), ", ".join(texts) or "none"))
    return rows


def print_rows(
    rows: Sequence[Row],
    names: Sequence[str],
    *,
    left: Container[int] = (),
    digits: int = 4,
) -> None:
    """Print some entries of each row in columns, below their labels."""
    cells = [
        [format_value(name, row.get(name), digits) for name in names]
        for row in rows
    ]
    print_columns([label_of(name) for name in names], cells, left=left)


def print_columns(
    heads: Sequence[str],
    rows: Iterable[Sequence[str]],
    *,
    left: Container[int],
) -> None:
    """Print one line per row, below a header, in aligned columns."""
    for line in align_columns(heads, rows, left=left):
        echo(line)


def print_table(rows: Sequence[tuple[str, str]]) -> None:
    """Print names and values in two columns."""
    width = max(len(name) for name, _ in rows)
    for name, value in rows:
        echo(f"  {name:<{width}}  {value}")


def print_run(run: "Run", more: dict[str, int] | None = None) -> None:
    """Print the summary of a run, with values of theory beside those of it.

    Of many pairs only those of players that decide; JSON has all. More
    numbers follow with their labels.
    """
    found = run.results()
    theory = found.pop("theory") or {}
    rows = [("outcome", f"{run.outcome.value}: {run.message}")]
    for name in ("outcome", "message", "seed", "duration_s"):
        del found[name]
    if run.game == "duel":
        since = found.pop("converged_at_s")
        missing = since is None and _missing_circle(run.summary)
        rows.append(("on the circle", missing or f"since {since:.1f} s"))
        begin = 2.0 / 3.0 * run.duration
        if since is not None and since > begin:
            rows.append(("means", f"measured from {begin:.1f} s on"))
        if words := theory["words"]:
            rows.append(("expected", words))
    radii = {
        "pursuer": {"radius_m": theory.get("radius_pursuer_m")},
        "evader": {"radius_m": theory.get("radius_m")},
    }
    groups = [
        (name, _facts(own, radii.get(name)))
        for name, own in found.pop("players").items()
    ]
    pairs, others = found.pop("pairs"), {*run.players} - {*run.deciding}
    for names, pair in pairs.items() if len(run.players) > 2 else ():
        if len(pairs) <= MOST_PAIRS or not others.issuperset(
            names.split(" - ")
        ):
            groups.append((names, _facts(pair)))
    for name, value in found.items():
        if isinstance(value, Mapping):
            groups.append((name, _facts(value)))
        elif isinstance(value, list):
            rows += [(name, ", ".join(value))] if value else []
        else:
            label = label_of(name)
            facts = _facts({name: value}, theory)
            rows += [(label, fact[len(label) + 1 :]) for fact in facts]
    rows += [(name, ", ".join(own)) for name, own in groups]
    rows += [(label_of(name), f"{n}") for name, n in (more or {}).items()]
    print_table(rows)


def _missing_circle(summary: "Summary") -> str:
    """Return why a duel did not end on its circle."""
    theory = summary.theory
    if theory is None or theory.expected in ("contact", "no circle"):
        return "not expected"
    if summary.triggered_at_s is None:
        return "not reached: the evader was never triggered"
    if theory.expected == "later":
        return "not reached, nor expected in this time"
    if theory.circle_since_s is not None:
        since = f"{theory.circle_since_s:.0f} s"
        return f"not reached: the template reaches it at {since}"
    return "not reached"


def _facts(
    values: Mapping[str, Any], theory: Mapping[str, Any] | None = None
) -> list[str]:
    """Return values and groups of them as texts, with those of theory."""
    facts: list[str] = []
    for name, value in values.items():
        if isinstance(value, Mapping) and name not in ERRORS:
            facts += _facts(value)
        elif isinstance(value, bool | int | float | str):
            text = format_value(name, value, 4)
            expected = (theory or {}).get(name)
            if expected is not None:
                text += f" (theory {format_value(name, expected, 4)})"
            facts.append(f"{label_of(name)} {text}")
    return facts
