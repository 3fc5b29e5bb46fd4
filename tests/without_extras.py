"""Run commands where nothing optional is installed; prints JSON.

``python without_extras.py COMMANDS``: COMMANDS is a JSON list of command
lines. Gives of each the line, its status, what it said, and what it printed.
"""

import json
import sys

from stepaside.core.extras import EXTRAS

BLOCKED = [name for names in EXTRAS.values() for name in names]

if __name__ == "__main__":
    sys.modules |= dict.fromkeys(BLOCKED)  # type: ignore[arg-type]
    from click.testing import CliRunner

    from stepaside.cli.main import main

    for line in json.loads(sys.argv[1]):
        result = CliRunner().invoke(main, line.split())
        failed = result.exception
        traceback = failed is not None and not isinstance(failed, SystemExit)
        said = repr(failed) if traceback else result.stderr
        row = [line, result.exit_code, said, result.stdout]
        print(json.dumps(row), flush=True)
