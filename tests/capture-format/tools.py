"""Foreign tools read what the library writes: exrheader, exrinfo and oiiotool open every part, and oiiotool's channel
statistics are those of the pixels that went in. usage: tools.py INTEGRATION STATISTICS (programs built beside this)"""
import math
import os
import re
import subprocess
import sys
import tempfile

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import programs  # noqa: E402


def run(*command):
    programs.find(command[0])
    done = subprocess.run(command, capture_output=True, text=True, env=programs.ENVIRONMENT)
    text = done.stdout + done.stderr
    status = 0 if command[0] == "exrinfo" else done.returncode  # exrinfo 3.1.5 never sets its status: its messages tell
    # A channel may be named "error".
    if status or re.search(r"EXR_ERR|ERROR|\berror:|non-conforming|unable to", text):
        sys.exit(f"{' '.join(command)}: {status}\n{text}")
    return done.stdout


def statistics(path):
    """{part: {channel: (min, max, mean)}} as reported by oiiotool."""
    names, result, part = [], {}, None
    for line in run("oiiotool", "--info", "-v", "-a", "--stats", path).split("\n"):
        if m := re.match(r"\s*channel list: (.*)", line):
            names = [n.split(" ")[0] for n in m[1].split(", ")]
        if m := re.match(r"\s*oiio:subimagename: \"(.*)\"", line) or re.match(r"\s*name: \"(.*)\"", line):
            part = m[1]
        if m := re.match(r"\s*Stats (Min|Max|Avg): (.*) \(float\)", line):
            for n, v in zip(names, m[2].split()):
                result.setdefault(part, {}).setdefault(n, []).append(float(v))
    return result


def main(example, expected):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "tools.exr")
        for compression in range(6):
            lines = run(expected, path, str(compression)).split("\n")
            if compression == 0:
                header, info = run("exrheader", path), run("exrinfo", "-v", path)
            found = statistics(path)
            compared = 0
            for line in filter(None, lines):
                part, channel, *numbers = line.split()
                if f'"{part}"' not in header or part not in info:
                    sys.exit(f"{part}: not in exrheader's or exrinfo's list")
                if part not in found or channel not in found[part]:
                    sys.exit(f"{part} {channel}: oiiotool does not list it: {found.keys()}")
                for want, got in zip(map(float, numbers), found[part][channel]):
                    # oiiotool prints six decimals, PXR24 keeps 15 bits of a float's fraction.
                    if abs(want - got) > 1e-6 + abs(want) * (2**-15 if compression == 4 else 2**-22):
                        sys.exit(f"compression {compression}: {part} {channel}: expected {want}, found {got}")
                    compared += 1
            if compared < 150:
                sys.exit(f"only {compared} statistics were compared")
        run(example, path)
        if set(statistics(path)) != {"gbuffer", "lit", "sky", "cubemap.000", "cubemap.001"}:
            sys.exit("the example's parts are not what oiiotool lists")


try:
    main(*sys.argv[1:])
except programs.Missing as missing:
    sys.exit(str(missing))
