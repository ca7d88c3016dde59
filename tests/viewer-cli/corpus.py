"""Hostile texts, as names of files and of what is in them."""
import unicodedata

MARK = "FORGED"  # begins a line only if a stranger's line break does

# As names of files and as texts. No slash and no NUL, which no name of a file has.
CORPUS = {
    "escape": f"a\x1b[31mb\x1b]0;t\x07c\x9bd\x1bP1;2q~\x1b\\",
    "lines": f"a\n{MARK} b\r{MARK} c\x0b\x0c\x85\u2028{MARK} d",
    "bidi": "gpj\u202eexe\u2066\u2069\u200f\u061c\ufeff\U000e0041",
    "markup": "<img src=x onerror=alert(1)><&lt;![CDATA[]]><!-- -->\"'`--><script>alert(2)<",
    "shell": "$(touch $PWNED)`touch $PWNED`;'\\''\"!!&|>x #\\",
    "formats": "%s%n%99999d{}${x}=cmd|' C'!A0 javascript:alert(1)",
    "dash": "--help -rf",
    "bytes": b"\xff\xc0\x9b\xed\xa0\x80 cut \xe2\x82".decode(errors="surrogateescape"),
    "long": "n" * 240,
}
SCRIPT_END = "</script><script>alert(3)</script><svg onload=alert(4)>\x1b[31m\x7f\x9b\u202e\n"  # in texts, where a slash may be


def hidden(text):
    """Characters that may not be printed: controls, marks of direction, and what has no width but joiners."""
    return [c for c in text if c != "\n" and (unicodedata.category(c) in ("Cc", "Cs", "Zl", "Zp") or (unicodedata.category(c) == "Cf" and c not in "\u200c\u200d"))]
