"""Python files of users: strategies and robots, given as FILE.py:NAME."""

import re
import sys
from pathlib import Path
from types import ModuleType

from .errors import ConfigurationError

FILE_AND_NAME = re.compile(r"(?P<file>.+\.py):(?P<name>[^:]*)", re.DOTALL)
# sys.exit() in user code must not end the program.
FAILURES = (Exception, SystemExit)


def load_user_file(path: str, where: str) -> ModuleType:
    """Execute a Python file, which may import modules of its folder.

    Args:
        path: Path of the file.
        where: What the file is given for, for messages.

    Raises:
        ConfigurationError: If there is no such file, or it fails to run.
    """
    file = Path(path).expanduser().resolve()
    if not file.is_file():
        raise ConfigurationError(f"{where}: there is no file {path}")
    module = f"stepaside_user_{file.stem}"
    while getattr(sys.modules.get(module), "__file__", str(file)) != str(file):
        module += "_"  # another file of this name
    loaded = ModuleType(module)
    loaded.__file__ = str(file)
    folder = str(file.parent)
    if folder not in sys.path:
        sys.path.append(folder)
    before = sys.modules.get(module)
    sys.modules[module] = loaded  # dataclasses look their module up there
    try:
        # Not by a loader: a cache of bytecode is stale for a file of the same
        # size that was written in the same second.
        exec(compile(file.read_bytes(), file, "exec"), vars(loaded))
    except FAILURES as error:
        del sys.modules[module]
        if before is not None:
            sys.modules[module] = before
        raise ConfigurationError(
            f"{where}: the file fails to run: {type(error).__name__}: {error}"
        ) from error
    return loaded
