"""Wire format of protocol buffers, as far as ONNX files need it.

A message is a sequence of fields: a key, which holds the number of the field
and its type, and a value. Robots read their strategies with this and numpy
alone.
"""

from collections import defaultdict
from struct import unpack

from ...core.errors import PolicyError

VARINT, FIXED64, BYTES, FIXED32 = 0, 1, 2, 5
Fields = dict[int, list[int | bytes]]


def encode_varint(value: int) -> bytes:
    """Encode an integer >= 0."""
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def encode_field(number: int, value: int | bytes | str) -> bytes:
    """Encode a field that holds an integer, bytes, a message or text.

    Args:
        number: Number of the field in its message.
        value: Its value.
    """
    if isinstance(value, int):
        return encode_varint(number << 3 | VARINT) + encode_varint(value)
    data = value.encode() if isinstance(value, str) else value
    return encode_varint(number << 3 | BYTES) + encode_varint(len(data)) + data


def decode_fields(data: bytes) -> Fields:
    """Decode the fields of a message: values by number, in order.

    Integers of fixed size are returned as bytes.

    Raises:
        PolicyError: If the data is not a message.
    """
    fields: Fields = defaultdict(list)
    at = 0
    while at < len(data):
        key, at = _varint(data, at)
        number, kind = key >> 3, key & 7
        if kind == VARINT:
            whole, at = _varint(data, at)
            fields[number].append(whole)
            continue
        if kind == BYTES:
            size, at = _varint(data, at)
        elif kind in (FIXED32, FIXED64):
            size = 4 if kind == FIXED32 else 8
        else:
            raise PolicyError(f"not a protocol buffer: type {kind} of a field")
        if at + size > len(data):
            raise PolicyError("not a protocol buffer: it ends within a field")
        fields[number].append(data[at : at + size])
        at += size
    return fields


def _varint(data: bytes, at: int) -> tuple[int, int]:
    """Return the integer at a position, and the position after it."""
    value = shift = 0
    while at < len(data) and shift < 70:
        byte = data[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return value, at
    raise PolicyError("not a protocol buffer: an integer does not end")


def texts(fields: Fields, number: int) -> list[str]:
    """Return the texts of a field.

    Raises:
        PolicyError: If one is not text.
    """
    try:
        return [each.decode() for each in blobs(fields, number)]
    except UnicodeDecodeError as error:
        raise PolicyError(
            "not a protocol buffer: a name is not text"
        ) from error


def blobs(fields: Fields, number: int) -> list[bytes]:
    """Return the values of a field that are bytes or messages."""
    return [v for v in fields.get(number, ()) if isinstance(v, bytes)]


def integers(fields: Fields, number: int) -> list[int]:
    """Return the integers of a field, packed or not."""
    found: list[int] = []
    for value in fields.get(number, ()):
        if isinstance(value, int):
            found.append(value)
            continue
        at = 0
        while at < len(value):
            one, at = _varint(value, at)
            found.append(one)
    return found


def real(fields: Fields, number: int, default: float) -> float:
    """Return the single-precision number of a field."""
    found = blobs(fields, number)
    if not found or len(found[0]) != 4:
        return default
    return float(unpack("<f", found[0])[0])
