"""Open and close pages of ``stepaside view`` and record its memory.

The server is a separate process whose duel runs in real time. Pages are
sockets that receive all messages and render nothing, four at a time;
``viewer.py`` opens real pages::

    python tools/benchmarks/page_memory.py --minutes 60
"""

import os
import socket
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep
from typing import Any

import viser
from benchmark_options import ask, machine
from websockets.exceptions import WebSocketException
from websockets.sync.client import ClientConnection, connect

from stepaside.studies.result_files import header, write_result

PORT = 8751
AT_ONCE = 4
WARM = 0.1  # fraction of the time after which memory counts
HEARS = 3.0  # time for which a page is open, in [s]


def resident(process: int) -> float:
    """Return the resident memory of a process, in [MB]."""
    status = Path(f"/proc/{process}/status").read_text()
    line = next(e for e in status.splitlines() if e.startswith("VmRSS:"))
    return int(line.split()[1]) / 1024.0


def page() -> ClientConnection:
    """Load the page as a browser does, and open its socket."""
    with socket.create_connection(("127.0.0.1", PORT), 30) as asking:
        lines = ("GET / HTTP/1.1", f"Host: 127.0.0.1:{PORT}", "", "")
        asking.sendall("\r\n".join(lines).encode())
        while asking.recv(2**20):
            pass
    return connect(
        f"ws://127.0.0.1:{PORT}",
        origin=f"http://127.0.0.1:{PORT}",  # type: ignore[arg-type]
        subprotocols=[f"viser-v{viser.__version__}"],  # type: ignore[list-item]
        proxy=None,
        max_size=None,
    )


def hear(pages: list[ClientConnection]) -> int:
    """Receive all messages for a while, then close the pages."""
    end, heard = monotonic() + HEARS, 0
    while monotonic() < end:
        for each in pages:
            try:
                heard += len(each.recv(timeout=0.02))
            except TimeoutError:
                continue
    for each in pages:
        each.close()
    return heard


def come_and_go(process: int, minutes: float) -> dict[str, Any]:
    """Return the memory of the server while pages open and close."""
    began, opened, heard = monotonic(), 0, 0
    rows: list[dict[str, float]] = []
    while (passed := (monotonic() - began) / 60.0) < minutes:
        try:
            pages = [page() for _ in range(AT_ONCE)]
        except (OSError, WebSocketException) as error:
            raise SystemExit(f"after {opened} pages: {error!r}") from error
        opened, heard = opened + AT_ONCE, heard + hear(pages)
        rows.append({"minute": passed, "resident_mb": resident(process)})
        print(f"{opened} pages, {rows[-1]}", flush=True)
    late = [r["resident_mb"] for r in rows if r["minute"] >= WARM * minutes]
    return {
        "pages": opened,
        "heard_mb": heard / 2**20,
        "first_mb": late[0],
        "last_mb": late[-1],
        "greatest_mb": max(late),
        "growth_mb": late[-1] - late[0],
        "rows": rows[:: max(1, len(rows) // 60)],
    }


def main() -> None:
    """Serve, measure and write the results."""
    asked = ask(__doc__, "page-memory.json")
    asked.add_argument("--minutes", type=float, default=60.0)
    arguments = asked.parse_args()
    words = ["view", "--run", "--no-open", f"--port={PORT}", "--seed=7"]
    words.append(f"--duration={60.0 * arguments.minutes + 600.0}")
    server = subprocess.Popen(
        [sys.executable, "-m", "stepaside", *words],
        stdout=subprocess.PIPE,
        env=os.environ | {"PYTHONUNBUFFERED": "1"},
    )
    assert server.stdout is not None
    try:
        server.stdout.readline()
        sleep(2.0)
        found = come_and_go(server.pid, arguments.minutes)
    finally:
        server.terminate()
        server.wait()
    settings = {
        "minutes": arguments.minutes,
        "at_once": AT_ONCE,
        "hears_s": HEARS,
    }
    head = header(settings)
    write_result(arguments.output, head, machine=machine(), memory=found)


if __name__ == "__main__":
    main()
