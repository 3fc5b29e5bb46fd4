"""Run commands of an installed package; needs nothing but that.

``make wheel`` installs the wheel into an environment of its own, with nothing
optional, and runs this there. Exit status 1 if a command shows a traceback.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

SHORT = "--duration 0.1 --json"
STATUS = {  # of each command line
    f"duel {SHORT} --output run": 0,
    "show run -o page.html": 0,
    "show run -o run.png": 0,
    f"run walk {SHORT}": 0,
    "theory plan --role evader --bearing 0.1 --json": 0,
    "run unicycles --duration 1 --json": 0,
    "theory circle --starts 2 --json": 0,
    "theory map --grid 2 --set distances=1 --set duration=1 --json": 0,
    "theory bound --grid 16 --json": 0,
    "study duels --set seed=0:1 --set duration=0.1 --workers 1 --json": 0,
    "robot --json": 0,
    "reproduce --help": 0,
    f"duel {SHORT} --sensing cameras": 2,
    f"duel {SHORT} --set control.method=mpc": 2,
    "view --no-open": 2,
    "show run -o film.mp4": 2,
    "play lola:none --role evader --set wait=0": 2,
    "serve --ros2 evader=/e --wait 0.1": 2,
}


def main() -> int:
    """Run each; 1 if one did not end as it should."""
    command = str(Path(sys.executable).parent / "stepaside")
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for line, status in STATUS.items():
            done = subprocess.run(
                [command, *line.split()],
                capture_output=True,
                text=True,
                cwd=folder,
            )
            said = done.stderr.strip()
            right = done.returncode == status and "Traceback" not in said
            if status:
                right &= "pip install 'stepaside[" in said
            wrong += not right
            print("right" if right else "WRONG", line, "|", said[-300:])
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
