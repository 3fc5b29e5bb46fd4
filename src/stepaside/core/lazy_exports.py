"""Public names of a package, imported when they are first used.

The names stand once, in the stub ``__init__.pyi`` beside the package, which
type checkers read too, one statement a line.
"""

import re
from importlib import import_module

TYPE_CHECKING = False  # of typing, which takes longer to load than this
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any


def lazy_exports(
    package: str, file: str
) -> "tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]":
    """Return ``__getattr__``, ``__dir__`` and ``__all__`` of a package.

    Every import in its stub is ``from .module import names``.
    """
    with open(f"{file.removesuffix('.py')}.pyi", encoding="utf-8") as stub:
        found = re.findall(r"(?m)^from (\S+) import (.+)$", stub.read())
    homes = {
        name.split(" as ")[-1]: package + module
        for module, names in found
        for name in names.split(", ")
    }

    def get(name: str) -> "Any":
        if name not in homes:
            raise AttributeError(
                f"module {package!r} has no attribute {name!r}"
            )
        return getattr(import_module(homes[name]), name)

    public = sorted(homes)
    return get, lambda: public, public
