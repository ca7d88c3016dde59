"""Writes the C file that puts the declarations of the public headers into libglint-capture, as the compiler reads them, for bindings of
other languages: declarations.py OUTPUT.c HEADER… -- COMPILER…"""
import re
import subprocess
import sys


def declarations(headers, compiler):
    """The text of these headers alone, without comments, macros and what they include."""
    source = "".join(f'#include "{header}"\n' for header in headers)
    run = subprocess.run([*compiler, "-E", "-x", "c", "-"], input=source, stdout=subprocess.PIPE, text=True, encoding="utf-8", check=True)
    kept, lines = False, []
    for line in run.stdout.splitlines():
        marker = re.match(r'#\s*(?:line\s+)?\d+\s+"(.*)"', line)
        if marker:
            kept = marker[1].endswith(tuple(headers))
        elif kept and not line.startswith("#"):
            lines.append(line)
    return re.sub(r"\s+", " ", " ".join(lines)).strip()


def main():
    output, *words = sys.argv[1:]
    split = words.index("--")
    text = declarations(words[:split], words[split + 1:])
    numbers = ",".join(map(str, text.encode("ascii") + b"\0"))
    with open(output, "w", encoding="utf-8") as file:
        file.write('#include "glint/common.h"\n\n'
                   f"static const char text[] = {{{numbers}}};\n\nconst char *glint_declarations(void) {{\n    return text;\n}}\n")


main()
