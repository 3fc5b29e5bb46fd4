"""Run a command that serves a page, and use the page's controls for a test.

Run as a program, with the words of the command. Each line on standard input
is a JSON list: a label and a value presses the control of that name, as a
viewer does; a label alone reads the value of a control, and "" all texts.
The answer is one line of JSON. Controls are those that viser makes.
"""

import json
import sys
from threading import Thread
from typing import Any

import viser
from matplotlib.figure import Figure

from stepaside.__main__ import main

CONTROLS: dict[str, Any] = {}
TEXTS: list[Any] = []


def record(name: str) -> None:
    """Remember the controls that a method of viser adds."""
    add = getattr(viser.GuiApi, name)

    def adds(gui: Any, *words: Any, **more: Any) -> Any:
        made = add(gui, *words, **more)
        if name == "add_markdown":
            TEXTS.append(made)
        elif hasattr(made, "value"):
            CONTROLS[str(words[0])] = made
            # The path of a setting stands before its meaning.
            path, colon, _ = str(more.get("hint")).partition(": ")
            if colon:
                CONTROLS[path] = made
        return made

    setattr(viser.GuiApi, name, adds)


def serve_hands() -> None:
    """Answer what a test asks."""
    for line in sys.stdin:
        label, *value = json.loads(line)
        answer: Any = None
        if not label:
            answer = [text.content for text in TEXTS]
        elif value:
            CONTROLS[label].value = value[0]
        else:
            control = CONTROLS[label]
            answer = [control.value, list(getattr(control, "options", ()))]
        print(json.dumps(answer), file=ANSWERS, flush=True)


for each in dir(viser.GuiApi):
    if each.startswith("add_"):
        record(each)
# Figures are drawn by other tests.
Figure.savefig = lambda figure, file, **more: file.write(b"")  # type: ignore[method-assign]
ANSWERS = sys.stdout
sys.stdout = sys.stderr
Thread(target=serve_hands, daemon=True).start()
main()
