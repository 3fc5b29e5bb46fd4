"""Settings: each is described once, at its field.

Checks, command-line options, comments of configuration files and the page of
settings all derive from this description.
"""

from collections.abc import Collection, Mapping
from dataclasses import MISSING, dataclass, field, fields, is_dataclass
from functools import cache
from numbers import Integral
from types import NoneType
from typing import Any, Literal, TypeVar, get_args, get_origin

from .errors import ConfigurationError, StepAsideError, as_number, shown
from .ranges import Range

T = TypeVar("T")
REQUIRED: Any = MISSING  # as a default: the setting has none
_KEY = "setting"  # in the metadata of a field


@dataclass(frozen=True)
class Setting:
    """Description of one setting.

    Attributes:
        meaning: What it sets, without final period. ``{unit}`` marks the
            place of the unit, which otherwise follows at the end; counts
            need none.
        range: Range of a number; None for any other value.
        names: Permitted texts; empty if any is.
        presets: Values by the name that an option takes instead.
        words: Special values by their word on the command line.
        default_text: What the help shows as default instead of the value.
        needs: Path and value of another setting without which this one, or
            this section, has no effect; an empty value stands for any but
            None.
    """

    meaning: str
    range: Range | None = None
    names: tuple[str, ...] = ()
    presets: Mapping[Any, Any] | None = None
    words: Mapping[str, Any] | None = None
    default_text: str = ""
    needs: tuple[str, str] | None = None

    @property
    def text(self) -> str:
        """The meaning with its unit, as a sentence."""
        text = self.meaning
        counts = self.range is None or self.range.whole
        if not counts and "{unit}" not in text:
            text += " {unit}"
        unit = f"[{self.range.unit}]" if self.range else ""
        return text.replace("{unit}", unit) + "."

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
    *,
    names: Collection[str] = (),
    presets: Mapping[Any, T] | None = None,
    words: Mapping[str, T] | None = None,
    default_text: str = "",
    needs: tuple[str, str] | None = None,
) -> T:
    """Declare a field of a dataclass of settings.

    Args:
        default: Default value, or ``REQUIRED``.
        meaning: As in :class:`Setting`, like all further arguments.
        range: Range of a number.
        names: Permitted texts; those of a ``Literal`` need not be given.
        presets: Values by name.
        words: Words for special values.
        default_text: Default shown in the help.
        needs: Condition.
    """
    described = Setting(
        meaning,
        range,
        tuple(names),
        presets,
        words,
        default_text,
        needs,
    )
    kind: dict[str, Any] = {"default": default}
    if isinstance(default, list):
        kind = {"default_factory": default.copy}
    made: T = field(**kind, metadata={_KEY: described})
    return made


def settings_of(kind: type[Any]) -> Mapping[str, Setting]:
    """Return the descriptions of a class of settings, by attribute."""
    found = {}
    for each in fields(kind):
        described: Setting | None = each.metadata.get(_KEY)
        if described is None:
            continue
        if get_origin(each.type) is Literal:
            names = {"names": get_args(each.type)}
            described = Setting(**vars(described) | names)
        found[each.name] = described
    return found


def ranges_of(kind: type[Any]) -> dict[str, Range]:
    """Return the ranges of the numbers of a class of settings."""
    return {
        name: described.range
        for name, described in settings_of(kind).items()
        if described.range is not None
    }


def check_settings(
    settings: Any,
    error: type[StepAsideError] = ConfigurationError,
    *,
    prefix: str = "",
) -> None:
    """Check ranges, names and types of settings.

    Numbers of other types, as of NumPy, are converted to Python numbers.

    Args:
        settings: Dataclass of settings. Attributes without range or names
            must have the type of their default: bool, text or a section.
        error: Class of the error.
        prefix: Prefix of each name in messages, like ``person.``.

    Raises:
        StepAsideError: Of class ``error``.
    """
    for name, described, default in _checks(type(settings)):  # type: ignore[arg-type]
        value, called = getattr(settings, name), f"{prefix}{name}"
        if described.range is not None:
            described.range.check(value, called, error)
            if type(value) not in (int, float, NoneType):  # NumPy, Fraction
                number = as_number(value, whole=isinstance(value, Integral))
                object.__setattr__(settings, name, number)
        elif described.names:
            if value not in described.names and value is not default:
                raise error(
                    f"{called} must be one of {', '.join(described.names)}, "
                    f"got {shown(value)}"
                )
        elif isinstance(default, bool | str) or is_dataclass(default):
            _check_type(value, type(default), called, error)


def _check_type(
    value: object, kind: type, name: str, error: type[StepAsideError]
) -> None:
    if not isinstance(value, kind):
        expected = _TYPE_NAMES.get(kind, f"a {kind.__name__}")
        raise error(f"{name} must be {expected}, got {shown(value)}")
    if isinstance(value, str) and "\0" in value:  # not valid in a file name
        raise error(
            f"{name} must be text without a null character, got {shown(value)}"
        )


_TYPE_NAMES = {bool: "true or false", str: "text"}


@cache
def _checks(kind: type[Any]) -> tuple[tuple[str, Setting, Any], ...]:
    """Return name, description and default of every setting."""
    described = settings_of(kind)
    return tuple(
        (each.name, described[each.name], each.default)
        for each in fields(kind)
        if each.name in described
    )
