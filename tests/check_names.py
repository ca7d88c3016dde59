"""Neither replay/ nor study/ names a slot, a variant or an image: what they look for is declared as a row ROLE and found by kind.
Fails on every string literal there that is such a name, but for those of EXCEPTIONS, a list that only shrinks."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Words with another meaning in these files.
EXCEPTIONS = {
    "replay/include/glint/replay.h": {"none"},  # disables a slot; also a variant of downsample
    "replay/plan/survey_record.c": {"none"},  # a kind of motion
    "study/metrics/metrics.c": {"rough"},  # a class of surfaces
    "study/shown/ends.c": {"sky"},  # the source of a reflection
    "study/shown/regions.c": {"hit", "sky"},  # the kind of end of a mirror ray
}
# JSON keys are the terms of run.json. These calls take literal keys; the argument of json_string is a value.
KEYED = re.compile(r"\bjson_(?:object_\w+|pack)\s*\(")


def registry():
    """All names that the passes declare."""
    names = set()
    for path in (ROOT / "passes").rglob("*.pass.h"):
        slot, variant = path.parent.name, path.name.removesuffix(".pass.h")
        names |= {slot, variant, f"{slot}/{variant}"}
    for path in (ROOT / "passes").rglob("*.h"):
        text = path.read_text(encoding="utf-8")
        names.update(re.findall(r"^(?:WRITE|DIAGNOSTIC)\(\w+,\s*(\w+),", text, re.M))
        names.update(re.findall(r"^CAPTURE\((\w+),", text, re.M))
    return names


def without_keys(text):
    """The text without the arguments of calls that take keys."""
    out, at = "", 0
    for call in KEYED.finditer(text):
        if call.start() < at:
            continue
        end, depth = call.end(), 1
        while depth and end < len(text):
            depth += {"(": 1, ")": -1}.get(text[end], 0)
            end += 1
        out += text[at:call.end()] + re.sub(r'"[^"\n]*"', lambda s: " " * len(s[0]), text[call.end():end])
        at = end
    return out + text[at:]


def main():
    names = registry()
    if len(names) < 150:
        sys.exit(f"only {len(names)} names found in passes/, expected the whole registry")
    faults, used = [], set()
    for path in sorted(p for folder in ("replay", "study") for p in (ROOT / folder).rglob("*.[ch]")):
        text = re.sub(r"/\*.*?\*/", lambda c: re.sub(r"[^\n]", " ", c[0]), path.read_text(encoding="utf-8"), flags=re.S)
        where = path.relative_to(ROOT).as_posix()
        for literal in re.finditer(r'"((?:[^"\\\n]|\\.)*)"', without_keys(text)):
            if literal[1] not in names:
                continue
            if literal[1] in EXCEPTIONS.get(where, {}):
                used.add((where, literal[1]))
                continue
            line = text.count("\n", 0, literal.start()) + 1
            faults.append(f'{where}:{line}: "{literal[1]}" is a name of the passes; expected a row ROLE, and its kind here')
    faults += [f"tests/check_names.py: {where} names {word} no more: take the exception out"
               for where, words in EXCEPTIONS.items() for word in words if (where, word) not in used]
    print("\n".join(faults), file=sys.stderr)
    sys.exit(1 if faults else 0)


main()
