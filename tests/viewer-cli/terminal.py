"""What a person at a terminal sees: widths, colours, hints at what was meant, and wrong files: terminal.py GLINT. Speaks TAP."""
import os
import re
import subprocess
import sys
import tempfile

import tap
from terminal_codes import sent

GLINT = os.path.abspath(sys.argv[1])
ESCAPE = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")
VIEWS = ["plan s.exr", "info s.exr", "lint s.exr", "replay s.exr -p kf2 --against truth", "diff run other", "passes", "passes screen_trace", "devices",
         "set --list", "sample --list", "help", "replay --help"]

# Wrong words, and what is meant.
MEANT = {
    "replay s.exr --presset mafia3": "--preset", "replay s.exr -p mafia4": "mafia3", "compare s.exr --presets mafia3,gtaw": "gtav",
    "replay s.exr --against truth --metrics rsme": "rmse", "blame s.exr --metric symetric": "symmetric", "view run --image reflecton -o x.png": "reflection",
    "replay s.exr --outputs reflecton": "reflection", "replay s.exr --set screen_trce.cells=3": "screen_trace", "replay s.exr --set screen_trace.cels=3": "cells",
    "replay s.exr --use screen_trace=hizz": "hiz", "replay s.exr --set pipeline.raies=3": "rays", "sample stret -o x.exr": "street",
    "view s.exr:lti -o x.png": "lit", "set s.exr exposur=2 -o x.exr": "exposure", "strip s.exr --keep gbufer -o x.exr": "gbuffer",
    "tune s.exr -o x.json --budget-ms 50% --vary screen_trce.cells": "screen_trace", "diff run other --metricss": "--metrics", "repaly": "replay",
    "view run --veiw raw": "--view", "view run --view sRGV -o x.png": "sRGB",
}

# Files that are no captures: their first bytes, and what is said of them.
OTHERS = {
    "x.png": (b"\x89PNG\r\n\x1a\n", "a PNG image; glint pack"), "x.jpg": (b"\xff\xd8\xff\xe0", "a JPEG image; glint pack"),
    "x.rdc": (b"RDOC\0\0\0\0", "a RenderDoc capture; docs/engines/renderdoc.md"), "x.json": (b' \n{"gbuffer": {}}', "a JSON file; glint pack"),
    "x.glb": (b"glTF\2\0\0\0", "a glTF scene; glint sample"), "x.zip": (b"PK\3\4", "a zip archive; glint pack"),
    "empty.exr": (b"", "an empty file"), "x.txt": (b"hello", "expected an OpenEXR file"),
}


def in_terminal(columns, words, **environment):
    """What a terminal of that width is sent, without escape sequences, and with them."""
    text = sent([GLINT, *words.split()], columns, **{"TERM": "xterm", **environment}).replace("\r\n", "\n")
    return "\n".join(ESCAPE.sub("", line.split("\r\x1b[K")[-1]) for line in text.split("\n")), text  # without the bar that is drawn over


def piped(words, **environment):
    return subprocess.run([GLINT, *words.split()], capture_output=True, text=True, env={**os.environ, **environment})


def words_of(text):
    """Times differ from run to run, and long words are broken."""
    text = re.sub(r"\d(\S*) [mµ]?s\b", r"\1", text)
    return {word for word in text.split() if not re.search(r"\d", word) and len(word) < 16}


class Tests:
    def __init__(self, folder):
        os.chdir(folder)
        for words in ("sample room --light 4 --size 48x27 --cube-size 8 --truth 1 -o s.exr", "replay s.exr -p kf2 -o run",
                      "replay s.exr -p kf2 -o other --set screen_trace.cells=8"):
            assert piped(words).returncode == 0, words

    def test_lines_fit_the_terminal_and_show_every_word(self):
        for words in VIEWS:
            for columns in (80, 40):
                text = in_terminal(columns, words)[0]
                assert len(text.splitlines()) > 1, (words, text)
                for line in text.splitlines():
                    assert len(line) <= columns or " " not in line.strip(), (columns, words, line)
            missing = words_of(piped(words).stdout) - words_of(text)
            assert not missing, (words, missing)

    def test_pipes_get_whole_lines_without_colour(self):
        said = piped("plan s.exr").stdout
        assert max(len(line) for line in said.splitlines()) > 80 and "\x1b" not in said

    def test_json_is_not_wrapped(self):
        assert max(len(line) for line in in_terminal(40, "plan s.exr --json")[0].splitlines()) > 40

    def test_colour_marks_failures_and_what_is_good(self):
        red, green, title = "\x1b[31mFAIL", "\x1b[32mPASS", "\x1b[1mpass"
        assert red in in_terminal(80, "diff run other")[1] and title in in_terminal(80, "diff run other")[1]
        assert green in in_terminal(80, "diff run run")[1]
        assert red in piped("diff run other --color always").stdout and "\x1b" not in piped("diff run other --color auto").stdout
        for words, environment in (("diff run other --color never", {}), ("diff run other", {"NO_COLOR": "1"}), ("diff run other", {"TERM": "dumb"})):
            assert "\x1b[3" not in in_terminal(80, words, **environment)[1], (words, environment)
        assert "\x1b[31mglint replay:" in in_terminal(80, "replay nothing.exr")[1]

    def test_wrong_words_get_the_one_that_is_meant(self):
        for words, meant in MEANT.items():
            done = piped(words)
            assert done.returncode not in (0, 1) or words.startswith("view"), (words, done)
            assert done.returncode != 0 and f"did you mean {meant}?" in done.stderr, (words, done.stderr)

    def test_options_that_are_right_are_not_taken_for_wrong(self):
        for words in ("replay s.exr -p kf2 --rep 1", "diff run run -fail 1", "diff run run --metrics rmse", "probe s.exr -p kf2 --alone -- 5,5", "plan s.exr --color=never"):
            assert piped(words).returncode == 0, (words, piped(words).stderr)

    def test_files_that_are_no_captures_are_named(self):
        os.makedirs("folder", exist_ok=True)
        for name, (start, said) in {**OTHERS, "folder": (None, "a folder")}.items():
            if start is not None:
                with open(name, "wb") as file:
                    file.write(start + b"\0" * 20 * bool(start))
            for command in ("replay", "lint", "info", "validate"):
                done = piped(f"{command} {name}")
                both = done.stdout + done.stderr
                assert (done.returncode != 0 and f"{name}: " in both and said in both) or (command == "info" and name == "folder"), (command, done)

    def test_no_driver_says_what_to_do(self):
        done = piped("replay s.exr", VK_ICD_FILENAMES="/nowhere.json", VK_DRIVER_FILES="")
        assert done.returncode == 1 and "VK_ICD_FILENAMES=/nowhere.json names none that works" in done.stderr and "-9" not in done.stderr, done.stderr

    def test_tune_groups_what_it_leaves_alone(self):
        done = piped("tune s.exr -o t.json --budget-fetches 200% --tries 2 --repeat 0 --rays 1")
        said = done.stdout
        assert "2 tries are few for " in done.stderr, done.stderr
        left = said[said.index("not tuned, because it"):].split("\n\n")[0].splitlines()[1:]
        reasons = [re.split(r"\s{2,}", line)[0] for line in left if not line.startswith("evaluations")]
        assert len(reasons) <= 10 and len(set(reasons)) == len(reasons), left
        names = sum(int(re.split(r"\s{2,}", line)[1]) for line in left if re.search(r"\s\d+\s", line))
        assert names > 20 and "cocoon: size, reach" in said, said


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as where:
        sys.exit(tap.run(Tests(where)))
