"""Small archives in the format of TorchScript, written without PyTorch."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from struct import pack
from typing import Any
from zipfile import ZipFile

import numpy as np


@dataclass(frozen=True)
class Module:
    """Module with the name of its class and its attributes."""

    class_name: str
    attributes: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Call:
    """Call of any function, as a hostile archive may hold."""

    function: str
    argument: str


def write_archive(path: Path, root: Any, code: Mapping[str, str]) -> Path:
    """Write an archive.

    Args:
        path: File to write.
        root: Outermost module.
        code: Text of each file of code, by module, as ``__torch__.a``.
    """
    storages: list[np.ndarray] = []
    described = _pickled(root, storages)
    with ZipFile(path, "w") as archive:
        archive.writestr("net/data.pkl", b"\x80\x02" + described + b".")
        archive.writestr("net/byteorder", "little")
        archive.writestr("net/version", "3\n")
        for i, values in enumerate(storages):
            archive.writestr(f"net/data/{i}", values.tobytes())
        for module, text in code.items():
            name = module.replace(".", "/")
            archive.writestr(f"net/code/{name}.py", text)
    return path


def _pickled(value: Any, storages: list[np.ndarray]) -> bytes:
    """Return the pickle of a value; the values of tensors go to a list."""
    if isinstance(value, Module):
        state = _pickled(dict(value.attributes), storages)
        return _named(value.class_name) + b")\x81" + state + b"b"
    if isinstance(value, Call):
        given = _pickled((value.argument,), storages)
        return _named(value.function) + given + b"R"
    if isinstance(value, np.ndarray):
        return _pickled_tensor(value, storages)
    if isinstance(value, dict):
        parts = [_pickled(x, storages) for item in value.items() for x in item]
        return b"}(" + b"".join(parts) + b"u"
    if isinstance(value, tuple | list):
        parts = [_pickled(each, storages) for each in value]
        end = (b"(", b"t") if isinstance(value, tuple) else (b"](", b"e")
        return end[0] + b"".join(parts) + end[1]
    if isinstance(value, bool) or value is None:
        return {True: b"\x88", False: b"\x89", None: b"N"}[value]
    if isinstance(value, str):
        text = value.encode()
        return b"X" + pack("<I", len(text)) + text
    return b"J" + pack("<i", value)


def _pickled_tensor(values: np.ndarray, storages: list[np.ndarray]) -> bytes:
    """Return the pickle of a tensor; equal arrays share a storage."""
    known = [i for i, each in enumerate(storages) if each is values]
    if not known:
        storages.append(values)
    key = str(known[0] if known else len(storages) - 1)
    size = values.itemsize
    strides = tuple(stride // size for stride in values.strides)
    kind = b"ctorch\nFloatStorage\n"
    texts = [_pickled(each, storages) for each in ("storage", key, "cpu")]
    storage = b"(" + texts[0] + kind + texts[1] + texts[2]
    storage += _pickled(values.size, storages) + b"tQ"
    rest = [_pickled(each, storages) for each in (0, values.shape, strides)]
    hooks = _named("collections.OrderedDict") + b")R"
    build = _named("torch._utils._rebuild_tensor_v2")
    return build + b"(" + storage + b"".join(rest) + b"\x89" + hooks + b"tR"


def _named(path: str) -> bytes:
    """Return the reference to a class or function."""
    module, _, name = path.rpartition(".")
    return f"c{module}\n{name}\n".encode()
