"""Commands that go on until they are told to stop, and what they say."""

import signal
import subprocess
from collections.abc import Callable
from threading import Thread
from time import monotonic, sleep
from typing import Any

LONGEST = 300.0  # [s], for what takes seconds on an idle machine


def until(done: Callable[[], Any], longest: float = LONGEST) -> Any:
    """Wait for something that is true, and return it."""
    end = monotonic() + longest
    while not (found := done()):
        assert monotonic() < end, "waited in vain"
        sleep(0.05)
    return found


class Running:
    """A command that was started; its output is read as it comes."""

    def __init__(self, process: "subprocess.Popen[str]") -> None:
        self.process = process
        self.out: list[str] = []
        self.err: list[str] = []
        self._readers = [
            Thread(target=self._read, args=pair, daemon=True)
            for pair in (
                (process.stdout, self.out),
                (process.stderr, self.err),
            )
        ]
        for reader in self._readers:
            reader.start()

    def _read(self, stream: Any, lines: list[str]) -> None:
        for line in stream:
            lines.append(line)

    @property
    def said(self) -> str:
        """What came on standard error so far."""
        return "".join(self.err)

    def until_said(self, words: str, longest: float = LONGEST) -> None:
        """Wait for words on standard error."""
        end = monotonic() + longest
        while words not in self.said:
            assert monotonic() < end, f"waited for {words!r}: {self.said}"
            sleep(0.01)

    def end(self) -> int:
        """Wait for its end, and return its exit status."""
        status = self.process.wait(LONGEST)
        for reader in self._readers:
            reader.join(LONGEST)
        return status

    def interrupt(self) -> int:
        """Press Ctrl-C, and wait for its end."""
        self.process.send_signal(signal.SIGINT)
        return self.end()

    def close(self) -> None:
        """End it if it still runs."""
        self.process.kill()
        self.process.wait(LONGEST)
        for stream in (self.process.stdin, self.process.stdout):
            if stream is not None:
                stream.close()
