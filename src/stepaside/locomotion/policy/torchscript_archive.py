"""Contents of a TorchScript archive, read without PyTorch.

An archive is a ZIP file: ``data.pkl`` describes the modules with their
attributes, ``data/`` holds the values of tensors, and ``code/`` the methods
of each class as Python text. The description is a pickle, which could call
any function; here it may only build modules, tensors and lists.
"""

import ast
import pickle
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import BadZipFile, ZipFile

import numpy as np

from ...core.errors import PolicyError
from ...core.poses import Array

STORAGES = {  # NumPy types by the name of the storage's type
    "FloatStorage": "f4",
    "DoubleStorage": "f8",
    "HalfStorage": "f2",
    "LongStorage": "i8",
    "IntStorage": "i4",
    "BoolStorage": "?",
    "ByteStorage": "u1",
}
LARGEST = 256 * 2**20  # of an entry of the archive, in [B]


@dataclass(eq=False)
class ScriptModule:
    """Module of a TorchScript program.

    Attributes:
        class_name: Qualified name of its class, as ``__torch__.nn.Linear``.
        attributes: Submodules, tensors and plain values by name.
    """

    class_name: str
    attributes: dict[str, Any] = field(default_factory=dict)

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        """Set the attributes, as the pickle of an archive asks for."""
        self.attributes = dict(state)


@dataclass(frozen=True, eq=False)
class StoredTensor:
    """Tensor with its values; two names of one tensor have equal keys.

    Attributes:
        key: Storage of its values, offset, shape and strides.
        values: Its values.
    """

    key: tuple[Any, ...]
    values: Array


@dataclass(frozen=True)
class TorchScriptArchive:
    """Modules and code of a TorchScript program.

    Attributes:
        root: Outermost module.
        classes: Syntax trees of the classes and functions, by qualified
            name.
        constants: Tensors that the code refers to by index.
    """

    root: ScriptModule
    classes: Mapping[str, ast.ClassDef | ast.FunctionDef]
    constants: tuple[Any, ...]


def read_archive(path: Path) -> TorchScriptArchive:
    """Read a TorchScript archive.

    Raises:
        PolicyError: If the file is not an archive, or contains objects other
            than modules and tensors.
    """
    try:
        with ZipFile(path) as archive:
            return _read(archive)
    except OSError as error:
        raise PolicyError(
            f"legs: cannot read {path}: {error.strerror}"
        ) from error
    except PolicyError as error:
        raise PolicyError(f"legs: {path}: {error}") from error
    except (
        *(BadZipFile, EOFError, KeyError, IndexError, TypeError, ValueError),
        *(AttributeError, SyntaxError, pickle.UnpicklingError),
    ) as error:
        raise PolicyError(
            f"legs: {path} is not a TorchScript archive, as "
            "torch.jit.save writes it"
        ) from error


def _read(archive: ZipFile) -> TorchScriptArchive:
    """Read the entries of an open archive."""
    names = archive.namelist()
    described = [n for n in names if n.count("/") == 1 and "data.pkl" in n]
    folder = described[0].partition("/")[0]
    for entry in archive.infolist():
        if entry.file_size > LARGEST:
            raise PolicyError(
                f"{entry.filename} must be at most {LARGEST // 2**20} MiB"
            )
    order = _byte_order(archive, folder)
    root = _ModuleUnpickler(archive, f"{folder}/data.pkl", order).load()
    if not isinstance(root, ScriptModule):
        raise PolicyError("it holds no module: save it by torch.jit.save")
    constants: tuple[Any, ...] = ()
    if f"{folder}/constants.pkl" in names:
        entry_name = f"{folder}/constants.pkl"
        constants = _ModuleUnpickler(archive, entry_name, order).load()
    return TorchScriptArchive(root, _read_code(archive, folder), constants)


def _byte_order(archive: ZipFile, folder: str) -> str:
    """Return the byte order of the tensors, as NumPy writes it."""
    try:
        text = archive.read(f"{folder}/byteorder").decode()
    except KeyError:  # of PyTorch before 2.1
        return "<"
    return ">" if text.strip() == "big" else "<"


def _read_code(
    archive: ZipFile, folder: str
) -> dict[str, ast.ClassDef | ast.FunctionDef]:
    """Parse the code; nothing of it is executed."""
    found: dict[str, ast.ClassDef | ast.FunctionDef] = {}
    start = f"{folder}/code/"
    for name in archive.namelist():
        if name.startswith(start) and name.endswith(".py"):
            module = name[len(start) : -len(".py")].replace("/", ".")
            for node in ast.parse(archive.read(name).decode()).body:
                if isinstance(node, ast.ClassDef | ast.FunctionDef):
                    found[f"{module}.{node.name}"] = node
    return found


class _ModuleUnpickler(pickle.Unpickler):
    """Unpickler that builds modules, tensors and lists only."""

    def __init__(self, archive: ZipFile, entry: str, order: str) -> None:
        super().__init__(BytesIO(archive.read(entry)))
        self._archive, self._order = archive, order
        self._folder = entry.removesuffix(".pkl")

    def find_class(self, module: str, name: str) -> Any:
        """Return an allowed constructor by its name in PyTorch."""
        if module.startswith("__torch__"):
            return _class_of(f"{module}.{name}")
        known: dict[str, Any] = {
            "torch._utils._rebuild_tensor_v2": _build_tensor,
            "torch._utils._rebuild_parameter": _first_of,
            "torch.jit._pickle.restore_type_tag": _first_of,
            "torch.jit._pickle.build_tensorlist": _first_of,
            "torch.jit._pickle.build_intlist": _first_of,
            "torch.jit._pickle.build_doublelist": _first_of,
            "torch.jit._pickle.build_boollist": _first_of,
            "collections.OrderedDict": OrderedDict,
        }
        if module == "torch" and name in STORAGES:
            return STORAGES[name]
        try:
            return known[f"{module}.{name}"]
        except KeyError:
            raise PolicyError(
                f"it refers to {module}.{name}, which no network needs"
            ) from None

    def persistent_load(self, given: Any) -> tuple[str, Array]:
        """Return a storage of tensor values with its name."""
        _, kind, key, _, _ = given
        data = self._archive.read(f"{self._folder}/{key}")
        values = np.frombuffer(data, np.dtype(kind).newbyteorder(self._order))
        return str(key), values


def _class_of(class_name: str) -> type[ScriptModule]:
    """Return a class whose instances are modules of this class name."""

    def create(cls: type[ScriptModule]) -> ScriptModule:
        module = object.__new__(cls)
        module.class_name, module.attributes = class_name, {}
        return module

    made: type[ScriptModule] = type(
        "ScriptModuleOfClass", (ScriptModule,), {"__new__": create}
    )
    return made


def _first_of(value: Any, *_: Any) -> Any:
    return value


def _build_tensor(
    storage: tuple[str, Array],
    offset: int,
    shape: tuple[int, ...],
    strides: tuple[int, ...],
    *_: Any,
) -> StoredTensor:
    """Return a tensor as a view of its storage, checked for its extent."""
    name, values = storage
    extent = sum((n - 1) * s for n, s in zip(shape, strides, strict=True))
    if min((*shape, *strides, offset), default=0) < 0 or (
        0 not in shape and offset + extent >= values.size
    ):
        raise PolicyError(f"tensor {name} exceeds its storage")
    size = values.itemsize
    view = np.lib.stride_tricks.as_strided(
        values[offset:], shape, [size * stride for stride in strides]
    )
    copy: Array = np.array(view, dtype=values.dtype.newbyteorder("="))
    return StoredTensor((name, offset, shape, strides), copy)
