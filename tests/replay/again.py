"""Studies whose device is lost in the middle: they go on with a new one, and end with the results of one that was never disturbed. A step that loses the device twice ends
them with an error that names it; what the journal has by then is kept, and resumed.

again.py GLINT LAYER_FOLDER [all]
"""
import collections
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap  # noqa: E402

# CAPTURE and OUT are replaced.
STUDIES = {
    "sweep": "sweep CAPTURE -o OUT --preset PLAIN --vary cubemap_trace.steps_hq=4,8,16 --repeat 0 --rays 16 --json",
    "tune": "tune CAPTURE -o OUT.json --folder OUT --preset PLAIN --vary cubemap_trace.steps_hq=4..32 --budget-fetches 200% --tries 4 --repeat 0 --rays 16 --overwrite --json",
    "blame": "blame CAPTURE -o OUT --preset PLAIN --exact 0 --permutations 2 --repeat 0 --rays 16 --json",
    "compare": "compare CAPTURE --presets kf2,gtav --effect reflection --repeat 1 --json",
    "reference": "reference CAPTURE -o OUT --rays 32 --json",
}
# What differs from run to run.
TIMES = re.compile(r"seconds|_ms$|^ms$|time|frame|cubemaps|total|folder|output|command|run$|reference_runs|evaluated|file|fresh|search")


def lasting(value):
    """The value without times."""
    if isinstance(value, dict):
        return {k: lasting(v) for k, v in value.items() if not TIMES.search(k)}
    return [lasting(v) for v in value] if isinstance(value, list) else value


class Again:
    def __init__(self):
        self.everything = len(sys.argv) > 3
        self.folder = tempfile.mkdtemp(prefix="glint-again-")
        self.capture = os.path.join(self.folder, "tiny.exr")
        tap.glint("sample", "street", "--light=1", "-o", self.capture, "--size", "32x18", "--cube-size", "8", "--truth", "1")

    def run(self, study, out, **fault):
        names = {"CAPTURE": self.capture, "OUT": os.path.join(self.folder, out), "PLAIN": tap.PLAIN, "OUT.json": os.path.join(self.folder, out + ".json")}
        words = [names.get(word, word) for word in STUDIES[study].split()]
        environment = {**os.environ, "VK_LAYER_PATH": sys.argv[2], "VK_INSTANCE_LAYERS": "VK_LAYER_GLINT_fault",
                       "GLINT_FAULT_STAY": os.path.join(sys.argv[2], "libglint_fault.so")}  # and counts on, with each instance
        environment |= {f"GLINT_FAULT_{name}": str(value) for name, value in fault.items()}
        return subprocess.run([sys.argv[1], *words], capture_output=True, text=True, env=environment, timeout=600)

    def results(self, run, study, out):
        """What a study found: what it printed, and the reference's pixels."""
        found = [lasting(json.loads(run.stdout.replace(os.path.join(self.folder, out), "OUT")))]
        if study == "reference":
            folder = os.path.join(self.folder, out)
            for name in sorted(n for n in os.listdir(folder) if n.endswith(".exr")):
                part = subprocess.run([sys.argv[1], "diff", "--json", os.path.join(folder, name), os.path.join(self.folder, "reference-whole", name)], capture_output=True, text=True)
                assert part.returncode == 0, part.stdout + part.stderr
        return found

    def lose(self, study):
        counts, path = collections.Counter(), os.path.join(self.folder, study + "-counts")
        whole = self.run(study, study + "-whole", COUNTS=path)
        assert whole.returncode == 0, whole.stderr
        with open(path, encoding="utf-8") as lines:
            for line in lines:
                counts[line.split()[0]] += int(line.split()[1])
        expected = self.results(whole, study, study + "-whole")
        last = counts["vkQueueSubmit2"]
        assert last > 40, last
        parts = [0.3, 0.6, 0.9] if self.everything else [0.8]
        for part in parts:
            number, out = int(last * part), f"{study}-{part:.2f}"
            once = self.run(study, out, CALL="vkQueueSubmit2", FROM=number, TIMES=1)
            said = f"{study} {number} of {last}: {once.returncode} {once.stderr[-1500:]}"
            assert once.returncode == 0 and once.stderr.count("the device was lost") == 1, said
            assert "trying again" in once.stderr or "going on after" in once.stderr, said
            assert self.results(once, study, out) == expected, (said, self.results(once, study, out), expected)
            twice = self.run(study, out + "-twice", CALL="vkQueueSubmit2", FROM=number)
            said = f"{study} {number} of {last}: {twice.returncode} {twice.stderr[-1500:]}"
            assert twice.returncode not in (0, 130) and twice.returncode > 0 and "tried twice" in twice.stderr, said
            assert self.capture in twice.stderr, said
            resumed = self.run(study, out + "-twice")
            assert resumed.returncode == 0, resumed.stderr
            assert self.results(resumed, study, out + "-twice") == expected, (said, self.results(resumed, study, out + "-twice"), expected)

    def finish(self):
        shutil.rmtree(self.folder)


def one(study):
    return lambda self: self.lose(study)


for name in STUDIES if len(sys.argv) > 3 else ["sweep"]:
    setattr(Again, "test_" + name, one(name))
tests = Again()
try:
    failed = tap.run(tests)
finally:
    tests.finish()
sys.exit(failed)
