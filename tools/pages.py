"""What the scripts that write docs/ share: running glint, presets with one thing changed, tables, times of devices.

A row of a page is (name, words); a word is SLOT=VARIANT, none to leave the slot out, or SLOT.PARAMETER=VALUE. A page with
times defines timed(): {scene: {key: preset}}; tools/times.py measures these presets on a device, and Times reads the record."""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

os.environ["GLINT_CACHE"] = "none"  # each run executes all passes

HERE = pathlib.Path(__file__).parent
PRESETS = HERE.parent / "samples/presets"
RECORDS = HERE / "records/times"
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
KINDS = ("mirror-like", "glossy", "rough")


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout


def arguments(about, measure, page, size, cube, truth):
    """The parser of a script that measures samples, with measure(args), and writes a page of that, with page(args); and its first command, for more options."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    measuring, writing = commands.add_parser("measure"), commands.add_parser("page")
    measuring.add_argument("glint")
    measuring.add_argument("-o", "--output", required=True, type=pathlib.Path)
    measuring.add_argument("--size", default=size)
    measuring.add_argument("--cube", default=cube)
    measuring.add_argument("--truth", default=truth)
    measuring.add_argument("--work", help="folder for temporary files")
    measuring.set_defaults(act=measure)
    writing.add_argument("glint")
    writing.add_argument("record", type=pathlib.Path)
    writing.add_argument("-o", "--docs", default=HERE.parent / "docs", type=pathlib.Path)
    writing.set_defaults(act=page)
    return parser, measuring


def sample(glint, scene, folder, size, cube, *options):
    path = pathlib.Path(folder) / f"{scene}.exr"
    run(glint, "sample", scene, "-o", path, "--size", size, "--cube-size", cube, *options)
    return path


def options(words):
    """The options of glint replay for these words."""
    return [o for word in words.split() for o in ("--set" if "." in word.split("=")[0] else "--use", word)]


def preset(name, words=""):
    made = json.loads((PRESETS / f"{name}.json").read_text())
    for what, value in (word.split("=") for word in words.split()):
        if "." in what:
            made["set"][what] = value
        elif value == "none":
            del made["slots"][what]
        else:
            made["slots"][what] = value
    return made


def usable(glint, presets):
    """Without settings of a replaced variant that its successor does not have; --use drops them as well."""
    known = {(p["slot"], p["variant"]): {parameter["name"] for parameter in p["parameters"]} for p in json.loads(run(glint, "passes", "--json"))["passes"]}
    return {key: {**made, "set": {name: value for name, value in made["set"].items()
                                  if not (slot := name.split(".")[0]) in made["slots"] or name in known[slot, made["slots"][slot]]}}
            for key, made in presets.items()}


def compare(glint, capture, presets, rounds, together=6):
    """The device, and the results of glint compare for each of {key: preset}; a limited number alternates and shares the memory."""
    report, keys, presets = {}, list(presets), usable(glint, presets)
    with tempfile.TemporaryDirectory() as folder:
        for first in range(0, len(keys), together):
            chosen = keys[first:first + together]
            files = [pathlib.Path(folder) / f"{first + i}.json" for i in range(len(chosen))]
            for file, key in zip(files, chosen):
                file.write_text(json.dumps(presets[key]))
            answer = json.loads(run(glint, "compare", capture, "--effect", "reflection", "--presets", ",".join(map(str, files)), "--repeat", rounds, "--json"))
            report.update(zip(chosen, answer["captures"][0]["presets"]))
    return answer["device"], report


def errors(glint, capture, name, words, *more, figures=("rmse",)):
    """Error of the reflection against the truth: mirror-like, glossy and rough surfaces, one cell for each figure."""
    report = json.loads(run(glint, "replay", capture, "--preset", name, "--json", "--against", "truth", *options(words), *more))
    found = {row["surfaces"]: row for row in report["runs"][0]["against_truth"]["image"]["surfaces"]}
    return [", ".join(f"{found[kind][figure]:.3f}" for kind in KINDS) for figure in figures]


def picture(glint, source, out, *more):
    """The picture of glint view for a run's image or a file's layer, without its legend."""
    run(glint, "view", source, "--no-legend", "-o", out, *more)
    return out


def sheet(tiles, columns, out, width=400, height=225):
    """A JPEG of (label, picture) tiles."""
    made = []
    for i, (label, file) in enumerate(tiles):
        made.append(pathlib.Path(file).with_name(f"tile-{i}.png"))
        run("oiiotool", file, "--ch", "R,G,B", "--resize:filter=box", f"{width}x{height}", "--create", f"{width}x{height + 20}", 3,
            "--paste", "+0+20", f"--text:x=4:y=15:size=13:font={FONT}", label, "-o", made[-1])
    run("oiiotool", *made, "--mosaic:pad=4", f"{columns}x{-(-len(made) // columns)}", "--compression", "jpeg:82", "-o", out)


def table(titles, rows):
    lines = ["| " + " | ".join(titles) + " |", "| --- |" + " ---: |" * (len(titles) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def draw(glint, charts, docs):
    """Charts as SVG files of these names."""
    with tempfile.TemporaryDirectory() as folder:
        page = {"format": 1, "title": "", "facts": [], "sections": [{"title": "", "blocks": [{"chart": c} for c in charts.values()]}]}
        (pathlib.Path(folder) / "page.json").write_text(json.dumps(page))
        for i, name in enumerate(charts):
            run(glint, "report", folder, "-o", docs / name, "--chart", i + 1)


class Times:
    """A page's columns of milliseconds, one for each device with a record."""

    def __init__(self, page=None):
        """Without a page there are no columns."""
        self.records = [json.loads(path.read_text()) for path in sorted(RECORDS.glob("*.json"))] if page else []
        self.page = page
        self.heads = [self.head(r) for r in self.records]

    def scene(self, record, scene):
        return record["pages"].get(self.page, {}).get(scene, {})

    def head(self, record, scenes=None):
        there = record["pages"].get(self.page, {})
        changes = any(ms["cubemaps"] for scene in scenes or there for ms in there.get(scene, {}).values())
        return f"GPU ms a frame{' (+ when cube maps change)' if changes else ''}, {record['as']}"

    def cells(self, scene, key):
        return [self.cell(self.scene(r, scene).get(key)) for r in self.records]

    def timed_columns(self, scene, keys):
        """Headings and {key: cells} of the devices with times of the scene."""
        records = [r for r in self.records if self.scene(r, scene)]
        return [self.head(r, [scene]) for r in records], {key: [self.cell(self.scene(r, scene).get(key)) for r in records] for key in keys}

    def untimed(self, scene):
        """The devices without times of the scene."""
        return ", ".join(r["as"] for r in self.records if not self.scene(r, scene))

    @staticmethod
    def cell(ms):
        if ms is None:
            return "not timed"
        return f"{ms['frame']:.3g}" + (f" + {ms['cubemaps']:.3g}" if ms["cubemaps"] else "")

    def report(self):
        if not self.records:
            return ""
        devices = "; ".join(f"{r['as']}: {r['size'].replace('x', '×')}, cube maps of {r['cube']}², median of {r['rounds']} alternating rounds"
                            + (f", the lowest of {r['tries']} measurements" if "tries" in r else "") for r in self.records)
        return f"GPU times are of all passes of a frame; after a + follows the time of the work on cube maps, which is done only when one changes ({devices}).\n"
