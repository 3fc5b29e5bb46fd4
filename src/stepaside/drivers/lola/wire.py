"""Wire format of LoLA: MessagePack maps of fixed keys, lengths and types.

Decoding is strict: it yields a complete frame of finite numbers, or a
:class:`WireError` that names the fault.
"""

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any, NamedTuple

import msgpack

from ..joint.frames import FrameError

SENSOR_BYTES = 896  # of every sensor frame
LONGEST_ANSWER = 4096  # more than any encoding of an actuator frame
MAX_FLOAT = 3.4028234e38  # largest number in single precision
MAX_TEXT = 31  # longest text with a one-byte header, in characters


class WireError(FrameError):
    """Bytes that are not a valid frame, or values that cannot be encoded."""


class Field(NamedTuple):
    """Key of a frame, with the type of its values.

    Attributes:
        key: Key on the wire.
        length: Number of values.
        kind: float, int, bool or str.
    """

    key: str
    length: int
    kind: type[Any] = float


SENSOR_FIELDS = (
    Field("Position", 25),
    Field("Stiffness", 25),
    Field("Current", 25),
    Field("Temperature", 25),
    Field("Status", 25, int),
    Field("Accelerometer", 3),
    Field("Gyroscope", 3),
    Field("Angles", 2),
    Field("FSR", 8),
    Field("Sonar", 2),
    Field("Touch", 14),
    Field("Battery", 4),
    Field("RobotConfig", 4, str),
)
ACTUATOR_FIELDS = (
    Field("Position", 25),
    Field("Stiffness", 25),
    Field("Chest", 3),
    Field("LEar", 10),
    Field("REar", 10),
    Field("LEye", 24),
    Field("REye", 24),
    Field("LFoot", 3),
    Field("RFoot", 3),
    Field("Skull", 12),
    Field("Sonar", 2, bool),
)
# Fields whose memory some peers leave uninitialised.
LIGHTS = frozenset(f.key for f in ACTUATOR_FIELDS[2:-1])
Values = dict[str, list[Any]]


class Pairs(list[tuple[Any, Any]]):
    """Keys and values of one map, in order, including duplicate keys."""


LIMITS = {
    "raw": False,
    "object_pairs_hook": Pairs,
    "max_str_len": 64,
    "max_bin_len": 0,
    "max_ext_len": 0,
    "max_array_len": 64,
    "max_map_len": 16,
}


def decode(data: bytes) -> Any:
    """Decode the bytes of one MessagePack object.

    Raises:
        WireError: If the bytes are anything else.
    """
    try:
        return msgpack.unpackb(data, **LIMITS)
    except Exception as error:  # msgpack raises many kinds of errors
        name = type(error).__name__
        raise WireError(
            f"cannot decode MessagePack: {name} {error}".strip()
        ) from error


def check_map(
    decoded: Any, fields: Sequence[Field], *, partial: bool = False
) -> Values:
    """Check that a decoded object is a frame of given fields.

    Args:
        decoded: Result of :func:`decode`.
        fields: Fields of the frame; other keys are not allowed.
        partial: Whether keys may be missing.

    Returns:
        Values by key; numbers of float fields are floats.

    Raises:
        WireError: With the first fault, if it is not such a frame.
    """
    if not isinstance(decoded, Pairs):
        raise WireError(f"a frame must be a map, got {_kind(decoded)}")
    known = {field.key: field for field in fields}
    values: Values = {}
    for key, value in decoded:
        if not isinstance(key, str) or key not in known:
            raise WireError(f"unknown key {key!r:.40}")
        if key in values:
            raise WireError(f"key {key} must occur once")
        values[key] = _check(known[key], value)
    missing = [key for key in known if key not in values]
    if missing and not partial:
        raise WireError(f"keys are missing: {', '.join(missing)}")
    return values


def encode(values: Mapping[str, Any], fields: Sequence[Field]) -> bytes:
    """Encode a frame in the order of its fields, floats as 4 bytes.

    Args:
        values: Values by key; missing keys are not encoded.
        fields: Fields of the frame.

    Raises:
        WireError: If a value has the wrong length or type, or is not
            finite in single precision.
    """
    checked = {
        field.key: _check(field, list(values[field.key]))
        for field in fields
        if field.key in values
    }
    data: bytes = msgpack.packb(checked, use_single_float=True)
    return data


def _check(field: Field, value: Any) -> list[Any]:
    """Return the values of one field, checked."""
    if not isinstance(value, list) or isinstance(value, Pairs):
        raise WireError(
            f"{field.key} must be an array of {field.length}, "
            f"got {_kind(value)}"
        )
    if len(value) != field.length:
        raise WireError(
            f"{field.key} must have {field.length} values, got {len(value)}"
        )
    if field.kind is float:
        return [_number(field.key, entry) for entry in value]
    for entry in value:
        if type(entry) is not field.kind:
            raise WireError(
                f"{field.key} must hold {field.kind.__name__} values, "
                f"got {_kind(entry)}"
            )
        if field.kind is int and not 0 <= entry <= 127:
            raise WireError(f"{field.key} must lie in [0, 127], got {entry}")
        if field.kind is str and len(entry) > MAX_TEXT:
            raise WireError(
                f"{field.key} must have at most {MAX_TEXT} characters, "
                f"got {len(entry)}"
            )
    return value


def _number(key: str, entry: Any) -> float:
    """Return a float from a float or, as some peers write it, an integer."""
    if type(entry) is not float and type(entry) is not int:
        raise WireError(f"{key} must hold numbers, got {_kind(entry)}")
    if not isfinite(entry) or abs(entry) > MAX_FLOAT:
        if key in LIGHTS and type(entry) is float:
            return 0.0
        raise WireError(f"{key} must be finite, got {entry}")
    return float(entry)


def _kind(value: Any) -> str:
    return "map" if isinstance(value, Pairs) else type(value).__name__
