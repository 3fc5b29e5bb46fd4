"""Run commands where nothing optional is installed; prints JSON.

``python without_extras.py COMMANDS``: COMMANDS is a JSON list of command
lines. Gives of each the line, its status and what it said.
"""

import json
import sys
from typing import Any

from stepaside.core.extras import EXTRAS

BLOCKED = {name for names in EXTRAS.values() for name in names}


class Blocked:
    """Finds that optional modules are nowhere."""

    def find_spec(self, name: str, *_: Any) -> None:
        """Say so, of those; leave others to others."""
        if name.partition(".")[0] in BLOCKED:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)


if __name__ == "__main__":
    sys.meta_path.insert(0, Blocked())
    from click.testing import CliRunner

    from stepaside.cli.main import main

    for line in json.loads(sys.argv[1]):
        result = CliRunner().invoke(main, line.split())
        failed = result.exception
        traceback = failed is not None and not isinstance(failed, SystemExit)
        said = repr(failed) if traceback else result.stderr
        print(json.dumps([line, result.exit_code, said]), flush=True)
