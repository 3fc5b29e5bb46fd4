"""Machine code of loops and formulas, compiled by LLVM at their first call.

Without the extra "fast", or where LLVM does not support the processor, there
are no kernels, and the same formulas run as plain Python, also on board.
Compiling the legs of a robot takes about 0.1 s once on a machine, and the
import of llvmlite half of that; it pays off within a few seconds of walking.
"""

import ctypes
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache, lru_cache, partial
from math import atan2, cos, sin, sqrt
from pathlib import Path
from struct import pack, unpack
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .kept_files import files_digest, kept
from .llvm_assembly import translate

Argument = NDArray[Any] | float
KEPT = 64  # kernels; those of a robot are about ten
LOOP = ctypes.PYFUNCTYPE(ctypes.c_int64, ctypes.c_void_p)
OPTIMISATION = 0  # of LLVM; formulas have no common subexpressions left
CHAIN = """\
define i64 @kernel(ptr %none) {{
{calls}
ret i64 0
}}
"""
CALLBACK = """\
define void @kernel(ptr %first, ptr %second) {{
%address = ptrtoint ptr %second to i64
%own = icmp eq i64 %address, {owner}
br i1 %own, label %inside, label %after
inside:
{calls}
br label %after
after:
ret void
}}
"""
_enabled = True
# Python 3.11 raises SystemError where two threads parse source at once.
_compiling = Lock()


def is_enabled() -> bool:
    """Return whether machine code is used where it is available."""
    return _enabled and _load_llvm() is not None


@contextmanager
def plain_python() -> Iterator[None]:
    """Make no kernels within the context."""
    global _enabled
    before, _enabled = _enabled, False
    try:
        yield
    finally:
        _enabled = before


class BoundKernel(partial[int]):
    """Compiled loop over given arrays: a function of the address of a frame.

    Attributes:
        kept: The frame, and the arrays that it refers to.
    """

    kept: tuple[object, ...]


class Kernel:
    """Compiled loop over arrays."""

    def __init__(self, name: str, source: str, arguments: str) -> None:
        """Note the source; it is compiled at the first call.

        Args:
            name: Name of the loop, for messages.
            source: See :func:`.llvm_assembly.translate`.
            arguments: Likewise.
        """
        self.name, self._source, self._arguments = name, source, arguments
        self._compiled: Any = None

    def __call__(self, *arguments: Argument) -> int:
        """Run the loop."""
        return self.bind(*arguments)()

    def bind(self, *arguments: Argument) -> BoundKernel:
        """Return the loop over these arrays, to be called many times.

        Args:
            arguments: Contiguous arrays, whose memory must stay where it is,
                and floats.

        Raises:
            TypeError: If an argument is not of its kind.
        """
        words: list[int] = []
        for letter, argument in zip(self._arguments, arguments, strict=True):
            words += self._words(letter, argument)
        frame = np.array(words, dtype=np.int64)
        bound = BoundKernel(self._function, _address_of(frame))
        bound.kept = frame, *arguments
        return bound

    @property
    def _function(self) -> Any:
        with _compiling:
            if self._compiled is None:
                inputs = self._source, self._arguments
                code = kept(
                    "loop",
                    (inputs, _translator()),
                    lambda: _assemble(translate(*inputs)),
                )
                self._compiled = _load(code, LOOP)
            return self._compiled

    def _words(self, letter: str, argument: Argument) -> list[int]:
        """Return the words of an argument in the frame."""
        if letter == "0":
            # The method view of a scalar of NumPy makes a new string of its
            # name at each call, which the method cache of Python keeps.
            return [*unpack("q", pack("d", float(argument)))]
        dimensions = 1 if letter == "i" else int(letter)
        kind = np.int64 if letter == "i" else np.float64
        if not (
            isinstance(argument, np.ndarray)
            and argument.dtype == kind
            and argument.ndim == dimensions
            and argument.flags.c_contiguous
        ):
            raise TypeError(
                f"{self.name} takes contiguous arrays of {kind.__name__} "
                f"with {dimensions} dimensions, got {argument!r}"
            )
        return [_address_of(argument), *argument.shape]


def _address_of(array: NDArray[Any]) -> int:
    address: int = array.__array_interface__["data"][0]
    return address


def kernel_of(name: str, source: str, arguments: str) -> Kernel | None:
    """Return a loop over arrays as machine code.

    Divisions by zero give inf or NaN, which the loop has to reject.

    Args:
        name: Name of the loop.
        source: Source that defines formulas, then the loop, in the subset of
            Python of :mod:`.llvm_assembly`.
        arguments: One letter for each argument: the number of dimensions of
            floats, or "i" for a row of integers.

    Returns:
        The loop; None without machine code.
    """
    return _kernel(name, source, arguments) if is_enabled() else None


@lru_cache(maxsize=KEPT)
def _kernel(name: str, source: str, arguments: str) -> Kernel:
    """Return a loop, which is compiled once for all its arrays."""
    return Kernel(name, source, arguments)


def bound_loop(
    name: str, source: str, arguments: str, *arrays: NDArray[Any]
) -> Callable[[], int]:
    """Return a loop over given arrays: machine code, or else plain Python.

    Args:
        name: Name of the loop.
        source: See :func:`kernel_of`; it defines no formulas.
        arguments: Likewise.
        arrays: Contiguous arrays, whose memory must stay where it is.
    """
    if is_enabled():
        return _kernel(name, source, arguments).bind(*arrays)
    known: dict[str, Any] = {
        "sin": sin,
        "cos": cos,
        "sqrt": sqrt,
        "atan2": atan2,
    }
    exec(compile(source, f"<{name}>", "exec"), known)
    return partial(known[name], *arrays)


def callback_of(kernels: Sequence[BoundKernel], owner: int) -> Any:
    """Return a C function that runs kernels one after the other.

    Args:
        kernels: Loops over their arrays.
        owner: Address that the second of the two arguments of the function
            must have; at other addresses it does nothing.

    Returns:
        The function, as ctypes describes it.
    """
    assembly = CALLBACK.format(owner=owner, calls=_calls_of(kernels))
    kind = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)
    function = _load(_assemble(assembly), kind)
    function.kernels = tuple(kernels)
    return function


def chained(*loops: Callable[[], object]) -> Callable[[], object]:
    """Return a function that runs loops one after the other.

    Args:
        loops: Loops over their arrays; bound kernels are joined to one.
    """
    kernels = [loop for loop in loops if isinstance(loop, BoundKernel)]
    if len(kernels) < len(loops):
        return partial(_run_all, loops)
    assembly = CHAIN.format(calls=_calls_of(kernels))
    bound = BoundKernel(_load(_assemble(assembly), LOOP), None)
    bound.kept = loops
    return bound


def _run_all(loops: Sequence[Callable[[], object]]) -> None:
    for loop in loops:
        loop()


def _calls_of(kernels: Sequence[BoundKernel]) -> str:
    """Return calls of kernels, as assembly."""
    calls = []
    for kernel in kernels:
        called: Any = kernel.func
        function = ctypes.cast(called, ctypes.c_void_p).value
        (address,) = kernel.args
        calls.append(
            f"call i64 inttoptr (i64 {function} to ptr)"
            f"(ptr inttoptr (i64 {address} to ptr))"
        )
    return "\n".join(calls)


@cache
def _load_llvm() -> Any:
    """Return the binding of LLVM, or None if it is not available."""
    with suppress(ImportError, RuntimeError):
        import llvmlite.binding as llvm

        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        return llvm
    return None


@cache
def _translator() -> tuple[object, ...]:
    """Return what object code depends on besides its source."""
    llvm = _load_llvm()
    features = llvm.get_host_cpu_features().flatten()
    here = Path(__file__)
    code = files_digest(here, here.with_name("llvm_assembly.py"))
    return code, llvm.llvm_version_info, llvm.get_host_cpu_name(), features


def _target_machine() -> Any:
    target = _load_llvm().Target.from_default_triple()
    return target.create_target_machine(opt=OPTIMISATION, jit=True)


def _assemble(assembly: str) -> bytes:
    """Return the object code of an assembly."""
    module = _load_llvm().parse_assembly(assembly)
    code: bytes = _target_machine().emit_object(module)
    return code


def _load(code: bytes, kind: Any) -> Any:
    """Return the function ``kernel`` of object code, of a type of ctypes."""
    llvm = _load_llvm()
    empty = llvm.parse_assembly("")
    engine = llvm.create_mcjit_compiler(empty, _target_machine())
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    function = kind(engine.get_function_address("kernel"))
    function.engine = engine  # which owns the code
    return function
