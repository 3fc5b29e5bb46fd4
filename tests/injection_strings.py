"""Strings that act as markup or commands unless they are escaped."""

HOSTILE = (
    *("@@RUN@@", "@@NAME@@", "@@POLICY@@", "@@@@RUN@@@@"),
    *("<img src=x onerror=ran=1>", "</script><script>ran=1</script>"),
    *("<!--<script>", "]]>", "\u2028ran=1//", "${ran=1}", "`", "'\"><svg>"),
    *("\x1b]0;owned\x07", "\x1b[2J", "\x9b31m", "\u202egnp.exe", "a\nb\r"),
    *("$\\frac{$", "$$", "$x", "_hidden", "\\$", "a\udc80b", "&lt;", "^{"),
    *("[a](javascript:ran=1)", "![a](x)", "# a", "| a |", "<iframe srcdoc=a>"),
)
