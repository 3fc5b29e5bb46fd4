"""Python files of users: strategies and robots, given as FILE.py:NAME."""

import re
import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, SourceFileLoader
from importlib.util import spec_from_file_location
from pathlib import Path
from types import CodeType, ModuleType

from .errors import FAILURES, ConfigurationError

FILE_AND_NAME = re.compile(r"(?P<file>.+\.py):(?P<name>[^:]*)", re.DOTALL)
# Files are modules of this one by their path, so that other processes can
# import what a pickle names.
__path__: list[str] = []
_DOT = "%2E"
_IMPORT = re.compile(r"^\s*(?:import|from)\s+(\w+)", re.MULTILINE)


class _Loader(SourceFileLoader):
    """Loader without a cache of bytecode.

    One is stale for a file of the same size that was written in the same
    second.
    """

    def get_code(self, fullname: str) -> CodeType:
        folder = str(Path(self.path).parent)
        if folder not in sys.path:
            sys.path.append(folder)
        code: CodeType = compile(self.get_data(self.path), self.path, "exec")
        return code


class _Finder(MetaPathFinder):
    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None,
        target: ModuleType | None = None,
    ) -> ModuleSpec | None:
        own, _, name = fullname.rpartition(".")
        if own != __name__:
            return None
        file = name.replace(_DOT, ".")
        return spec_from_file_location(
            fullname, file, loader=_Loader(fullname, file)
        )


sys.meta_path.append(_Finder())


def load_user_file(path: str, where: str) -> ModuleType:
    """Execute a Python file, which may import modules of its folder.

    Messages tell where it is given.
    """
    file = Path(path).expanduser().resolve()
    if not file.is_file():
        raise ConfigurationError(f"{where}: there is no file {file}")
    module = f"{__name__}.{file.as_posix().replace('.', _DOT)}"
    before = sys.modules.pop(module, None)
    _check_helpers(file, where)
    try:
        return import_module(module)
    except FAILURES as error:
        if before is not None:
            sys.modules[module] = before
        raise ConfigurationError(
            f"{where}: the file fails to run: {type(error).__name__}: {error}"
        ) from error


def _check_helpers(file: Path, where: str) -> None:
    """Check that no module beside a file has the name of another one.

    Python would give the file the module that was imported first.
    """
    text = file.read_text(encoding="utf-8", errors="replace")
    for name in set(_IMPORT.findall(text)):
        beside = file.with_name(f"{name}.py")
        loaded = getattr(sys.modules.get(name), "__file__", None)
        if loaded and beside.is_file() and not beside.samefile(loaded):
            raise ConfigurationError(
                f"{where}: it imports {name} from {beside}, but {loaded} has "
                "that name, too: give one of them another"
            )
