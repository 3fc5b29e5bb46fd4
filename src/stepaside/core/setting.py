"""Settings: each is described once, at its field.

The checks of constructors, the reading of files, command-line options,
comments of configuration files and the page of settings all derive from this
description and from the type of the field.
"""

from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from dataclasses import (
    MISSING,
    dataclass,
    field,
    fields,
    is_dataclass,
    replace,
)
from difflib import get_close_matches
from enum import Enum
from functools import cache
from math import inf, isfinite, radians, tau
from pathlib import Path
from types import NoneType, UnionType
from typing import (
    Any,
    ClassVar,
    Literal,
    NamedTuple,
    TypeVar,
    Union,
    cast,
    get_args,
    get_origin,
    get_type_hints,
)

from .errors import (
    ConfigurationError,
    StepAsideError,
    as_number,
    nearest_hint,
    shown,
)
from .ranges import Range

T = TypeVar("T")
REQUIRED: Any = MISSING  # as a default: the setting has none
ANGLES = {"rad": 1.0, "deg": radians(1.0)}  # units of angles in texts
NONE = "none"  # text of no value
_KEY = "setting"  # in the metadata of a field


@dataclass(frozen=True)
class Setting:
    """Description of one setting."""

    # What it sets, without final period. {unit} marks the place of the unit,
    # which otherwise follows at the end; counts need none.
    meaning: str
    # Range of a number, or of each number of an array or a table; None for
    # any finite one.
    range: Range | None = None
    names: tuple[str, ...] = ()  # permitted texts; empty if any is
    # Values by the name that an option takes instead.
    presets: Mapping[Any, Any] | None = None
    # What the help shows as default instead of the value.
    default_text: str = ""
    # Path and value of another setting without which this one, or this
    # section, has no effect; an empty value stands for any but None and
    # false.
    needs: tuple[str, str] | None = None
    # Least and greatest number of entries of an array.
    count: tuple[int, int] | None = None

    @property
    def text(self) -> str:
        """The meaning with its unit, as a sentence."""
        text = self.meaning
        if self.range is None:
            return text + "."
        if not self.range.whole and "{unit}" not in text:
            text += " {unit}"
        return text.replace("{unit}", f"[{self.range.unit}]") + "."

    def meant(self, text: str) -> Any:
        """Return the value of a preset or of an angle with its unit."""
        if self.presets is not None and text in self.presets:
            return self.presets[text]
        if self.range is not None and self.range.unit == "rad":
            for unit, factor in ANGLES.items():
                if text.endswith(unit):
                    with suppress(ValueError):
                        return float(text.removesuffix(unit)) * factor
        return text

    @property
    def full_text(self) -> str:
        """The meaning with unit and permitted values."""
        text = self.text.removesuffix(".")
        if self.range is not None:
            return f"{text}; {self.range.words}."
        if self.names:
            return f"{text}; one of {', '.join(self.names)}."
        return f"{text}."


def setting(
    default: T,
    meaning: str,
    range: Range | None = None,  # noqa: A002 (the term of the field)
    **more: Any,
) -> T:
    """Declare a field of settings, described by a :class:`Setting`."""
    described = Setting(meaning, range, **more)
    kind: dict[str, Any] = {"default": default}
    if isinstance(default, list | dict):
        kind = {"default_factory": default.copy}
    made: T = field(**kind, metadata={_KEY: described})
    return made


def descriptions_of(kind: type[Any]) -> Mapping[str, Setting]:
    """Return the descriptions of a class of settings, by attribute."""
    found = {}
    for each in fields(kind):
        described: Setting | None = each.metadata.get(_KEY)
        if described is None:
            continue
        if get_origin(each.type) is Literal:
            described = replace(described, names=get_args(each.type))
        found[each.name] = described
    return found


class Entry(NamedTuple):
    """Field of a dataclass or a named tuple."""

    hint: Any  # type
    described: Setting  # description
    default: Any  # default; REQUIRED if there is none


@cache
def entries_of(kind: Any, section: str = "") -> dict[str, Entry]:
    """Return every setting by its path, like ``physics.friction``."""
    found = dict[str, Entry]()
    for name, entry in _entries(kind).items():
        path = _joined(section, name)
        found[path] = entry
        if is_dataclass(entry.default):
            found |= entries_of(cast(Any, type(entry.default)), path)
    return found


def similar_paths(paths: Collection[str], name: str) -> list[str]:
    """Return paths of settings that a wrong path may mean, at most three."""
    last = name.rpartition(".")[2]
    near = [path for path in paths if path.rpartition(".")[2] == last]
    return (near or get_close_matches(name, paths, 3))[:3]


@cache
def _entries(kind: Any) -> dict[str, Entry]:
    hints = get_type_hints(kind)
    if not is_dataclass(kind):  # a named tuple
        defaults = kind._field_defaults
        return {
            name: Entry(hints[name], _PLAIN, defaults.get(name, MISSING))
            for name in kind._fields
        }
    found = {}
    for each in fields(kind):
        default = each.default
        if each.default_factory is not MISSING:
            default = each.default_factory()
        described = each.metadata.get(_KEY, _PLAIN)
        if each.init:
            found[each.name] = Entry(hints[each.name], described, default)
    return found


_PLAIN = Setting("")


@cache
def _parts(hint: Any) -> tuple[Any, tuple[Any, ...]]:
    return get_origin(hint), get_args(hint)


class EntryReader:
    """Reader of values by the types and descriptions of fields.

    Integers become floats where the type is float, arrays tuples, tables
    dataclasses or named tuples. A boolean is not a number, and a number is
    finite unless its range permits infinity.
    The problems are what does not fit: path, rule, unit and value of each.
    """

    def __init__(self, *, ignoring: bool = False) -> None:
        """Begin; unknown entries may be ignored."""
        self.problems: list[str] = []
        self._ignoring = ignoring

    @property
    def text(self) -> str:
        """The problems in one line, at most five of them."""
        more = len(self.problems) - 5
        listed = [*self.problems[:5], *([f"{more} more"] if more > 0 else [])]
        return "; ".join(listed)

    def read(
        self,
        value: Any,
        hint: Any,
        path: str,
        described: Setting = _PLAIN,
        base: Any = None,
    ) -> Any:
        """Return a value as a type; note a problem where it does not fit.

        The base gives values for entries that a table omits.
        """
        range = described.range
        if type(value) is hint:  # most often, and then most are valid
            if hint is float:
                low, high = range[:2] if range else (-inf, inf)
                if low < value <= high and value < inf:
                    return value
            elif value in described.names or is_dataclass(hint):
                return value
        elif hint is Any:
            return value
        origin, args = _parts(hint)
        if isinstance(value, str):
            text, value = value, described.meant(value)
            factor = ANGLES.get(text[-3:])
            if range and factor and type(value) is float:
                if not range.holds(value):
                    rule = range.scaled(1.0 / factor, text[-3:]).rule
                    self.problems.append(f"{path} must {rule}, got {text}")
                return value
            if described.presets is not None and isinstance(value, str):
                return self._note_choice(path, described.presets, value)
        if origin in (Union, UnionType):
            return self._read_any(value, args, path, described, base)
        if origin is Literal or described.names:
            names = described.names or args
            if isinstance(value, str) and value in names:
                return value
            return self._note_choice(path, names, value)
        if isinstance(value, Mapping) and hasattr(hint, "from_entries"):
            return self._read_by(hint.from_entries, value, path)
        if isinstance(value, str | int | float) and hasattr(hint, "from_text"):
            return self._read_by(hint.from_text, str(value), path)
        if is_dataclass(hint) or hasattr(hint, "_fields"):
            return self.read_table(value, hint, path, base)
        if origin in (tuple, list):
            return self._read_array(value, hint, path, described)
        if origin in (dict, Mapping):
            if not isinstance(value, Mapping):
                return self._note(path, "be a table", value)
            return {
                name: self.read(each, args[1], _joined(path, name), described)
                for name, each in value.items()
            }
        return self._read_scalar(value, hint, path, described)

    def read_table(
        self, value: Any, kind: Any, path: str, base: Any = None
    ) -> Any:
        """Return a dataclass or a named tuple; see :meth:`read`."""
        if isinstance(value, kind):
            return value
        entries, before = _entries(kind), len(self.problems)
        if not is_dataclass(kind) and isinstance(value, list | tuple):
            if len(value) > len(entries):
                rule = f"have {len(entries)} entries"
                return self._note(path, rule, len(value))
            value = dict(zip(entries, value, strict=False))
        if not isinstance(value, Mapping):
            return self._note(path, "be a table", value)
        if not self._ignoring:
            self._note_unknown(value, kind, path)
        values = {}
        for name, (hint, described, default) in entries.items():
            own = getattr(base, name) if isinstance(base, kind) else default
            if name in value:
                values[name] = self.read(
                    value[name], hint, _joined(path, name), described, own
                )
            elif own is MISSING:
                self.problems.append(f"missing entry {_joined(path, name)}")
        if len(self.problems) > before:
            return None
        try:
            if isinstance(base, kind) and is_dataclass(base):
                return replace(cast(Any, base), **values)
            return kind(**values)
        except StepAsideError as error:
            text = f"{error}"
            if path and not text.startswith(path.rpartition(".")[2]):
                text = f"{path}: {text}"
            self.problems.append(text)
        return None

    def _note(self, path: str, rule: str, value: Any) -> None:
        self.problems.append(f"{path} must {rule}, got {shown(value)}")

    def _note_choice(
        self, path: str, names: Collection[Any], value: Any
    ) -> None:
        self._note(path, f"be one of {', '.join(names)}", value)
        self.problems[-1] += nearest_hint(str(value), names)

    def _note_unknown(
        self, value: Mapping[str, Any], kind: Any, path: str
    ) -> None:
        entries = _entries(kind)
        unknown = [name for name in value if name not in entries]
        if not unknown:
            return
        near = [x for u in unknown for x in similar_paths(entries_of(kind), u)]
        hint = f"there are {', '.join(entries)}"
        if near:
            hint = (
                f"did you mean {' or '.join(_joined(path, n) for n in near)}?"
            )
        listed = ", ".join(_joined(path, name) for name in unknown)
        self.problems.append(f"unknown entry {listed}; {hint}")

    def _read_any(
        self,
        value: Any,
        hints: tuple[Any, ...],
        path: str,
        described: Setting,
        base: Any,
    ) -> Any:
        """Return a value as the first of several types that fits."""
        if NoneType in hints and (
            value is None or value == NONE and str not in hints
        ):
            return None
        told: list[str] = []
        before = len(self.problems)
        for hint in hints:
            if hint is NoneType:
                continue
            found = self.read(value, hint, path, described, base)
            if len(self.problems) == before:
                return found
            own = self.problems[before:]
            if not told or not own[0].startswith(f"{path} must"):
                told = own  # of the type whose shape fits
            del self.problems[before:]
        self.problems += told
        return None

    def _read_by(
        self, read: Callable[[Any], Any], value: Any, path: str
    ) -> Any:
        try:
            return read(value)
        except StepAsideError as error:
            self.problems.append(f"{path}: {error}")
        return None

    def _read_array(
        self, value: Any, hint: Any, path: str, described: Setting
    ) -> Any:
        kind, kinds = _parts(hint)
        if kind is list or kinds[-1] is ...:
            low, high = described.count or (0, None)
        else:
            low, high = len(kinds), len(kinds)
        if not isinstance(value, list | tuple):
            return self._note(path, "be an array", value)
        size = len(value)
        if size < low or high is not None and size > high:
            count = f"{low}" if low == high else f"{low} to {high}"
            return self._note(path, f"have {count} entries", size)
        if kind is list or kinds[-1] is ...:
            kinds = (kinds[0],) * size
        return kind(
            self.read(each, inner, f"{path} {number}", described)
            for number, (each, inner) in enumerate(
                zip(value, kinds, strict=True), start=1
            )
        )

    def _read_scalar(
        self, value: Any, kind: Any, path: str, described: Setting
    ) -> Any:
        if kind in (int, float):
            return self._read_number(value, kind, path, described.range)
        if kind is Path and isinstance(value, str):
            value = Path(value)
        elif issubclass(kind, Enum) and value in {each.value for each in kind}:
            return kind(value)
        if not isinstance(value, kind):
            expected = _TYPE_NAMES.get(kind, f"a {kind.__name__}")
            return self._note(path, f"be {expected}", value)
        if "\0" in str(value):  # not valid in a file name
            return self._note(path, "have no null character", value)
        return value

    def _read_number(
        self, value: Any, kind: Any, path: str, range: Range | None
    ) -> Any:
        number = as_number(value, whole=kind is int)
        if range is not None:
            fits, rule = range.holds(value), range.rule
            if range.unit == "rad" and tau < abs(number or 0.0) <= 360.0:
                rule += f" ({number:g}deg for degrees)"
        else:
            fits = number is not None and isfinite(number)
            rule = "be an integer" if kind is int else "be a finite number"
        return number if fits else self._note(path, rule, value)


_TYPE_NAMES = {bool: "true or false", str: "text"}


def _joined(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


def check_settings(
    settings: Any,
    error: type[StepAsideError] = ConfigurationError,
    *,
    prefix: str = "",
) -> None:
    """Check types, ranges and names of settings, and convert numbers.

    Names in messages have the prefix, like ``person.``.
    """
    reader, kind = EntryReader(), cast(Any, type(settings))
    for name, (hint, described, default) in _entries(kind).items():
        value = getattr(settings, name)
        if described is _PLAIN or value is default:  # which is valid
            continue
        read = reader.read(value, hint, f"{prefix}{name}", described)
        if read is not value and not reader.problems:
            object.__setattr__(settings, name, read)
    if reader.problems:
        raise error(reader.text)


class CheckedSettings:
    """Base of settings that :func:`check_settings` alone checks."""

    __slots__ = ()
    _checks: ClassVar[tuple[type[Exception], str]] = ConfigurationError, ""

    def __init_subclass__(
        cls,
        error: type[StepAsideError] = ConfigurationError,
        prefix: str = "",
    ) -> None:
        # A dataclass with slots is made again, without these arguments.
        if (error, prefix) != (ConfigurationError, ""):
            cls._checks = error, prefix

    def __post_init__(self) -> None:
        error, prefix = self._checks
        check_settings(self, cast(Any, error), prefix=prefix)
