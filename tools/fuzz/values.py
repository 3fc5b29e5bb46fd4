"""Invalid values, and bounds of ranges."""

from math import inf, nan, nextafter
from random import Random
from typing import Any

from stepaside.core.ranges import Range

NUMBERS = (
    *("nan", "inf", "-inf", "-nan", "1e18", "-1e18", "1e300", "1e-300"),
    *("5e-324", "-5e-324", "1e308", "1e999", "-1", "-0.0", "0", "1e-18"),
    *("true", "True", "None", "null", "0x10", "1_0", "1e", "e5", "--1", "+"),
    *("", " ", "1,5", "1 2", "1;2", "1j", "1/0", "1%", "\uff11", "\u0661"),
    *("9" * 5000, "0." + "0" * 5000 + "1", "[" * 900, "1" * 20, "1.5"),
)
TEXTS = (
    *("", " ", ".", "..", "/", "-", "--", "~", "*", "nan", "0", "None"),
    *("a" * 300, "a/" * 3000, "\x1b[2J", "a\nb", "\u202egnp.exe"),
    *("a\udc80b", "é" * 200, "$\\frac{$", "<img src=x onerror=ran=1>"),
    *("%s%n", "{0}", "${x}", "$(id)", "`id`", "; id", "file:///etc/passwd"),
    *("/dev/null/x", "/dev/full", "/proc/self/mem", "/proc/x", "\\\\host\\x"),
    *("nao/../nao", "x.py:", ":x", "x.py:y", "lola:", "lola:x:99999", "a:b"),
    *("1@1:1", "1e300@1:0", "1@-1:0", "nan@0:0", "1@0:nan", "@:", "1@1"),
    *("0:0", "0:1e9", "9" * 50, "-1:5", "5:1", "0:999999999"),
)
ANGLES = ("1deg", "200deg", "1e18deg", "nandeg", "-1e300rad", "deg", "1grad")


def around(allowed: Range) -> list[str]:
    """Return the bounds of a range and their neighbours, as text."""
    if allowed.whole:
        low, high = int(allowed.low), int(allowed.high)
        return [str(v) for v in (low - 1, low, low + 1, high, high + 1)]
    ends = (allowed.low, allowed.high)
    beyond = [nextafter(allowed.low, -inf), nextafter(allowed.high, inf)]
    return [repr(float(value)) for value in (*ends, *beyond)]


def any_value(random: Random) -> Any:
    """Return a Python value that a caller may pass by mistake."""
    return random.choice(
        [
            *(nan, inf, -inf, 1e18, -1e18, 1e300, 5e-324, -1, 0, 10**400),
            *(True, False, None, "", "x", b"x", [], {}, (), [nan], object()),
            *(1j, "9" * 5000, [[]], {"a": 1}, -0.0, 2**63, 1e-300),
        ]
    )
