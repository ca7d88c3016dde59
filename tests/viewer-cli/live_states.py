"""glint live: the run of a state is that of the command line which the page prints, byte for byte in the EXR files.

live_states.py GLINT STATES: that many random states of a capture, and a few of a shot."""
import filecmp
import pathlib
import random
import shlex
import subprocess
import sys
import tempfile

import tap
from live import Live, Refused

GLINT, STATES = sys.argv[1], int(sys.argv[2])
SHOT_STATES = max(1, STATES // 10)


def random_value(parameter, draw):
    if "choices" in parameter:
        return draw.choice(parameter["choices"])
    if parameter["type"] == "bool":
        return draw.random() < 0.5
    low, high = parameter["lowest"], parameter["highest"]
    # near the default: at the ends of the ranges are images of gigabytes and passes of minutes
    low, high = max(low, parameter["default"] / 2), min(high, 2 * parameter["default"] + 1)
    return draw.uniform(low, high) if parameter["type"] == "float" else draw.randint(int(low), max(int(low), int(high)))


def random_state(registry, presets, draw):
    passes = registry["passes"]
    state = {"preset": draw.choice(presets), "use": {}, "set": {}}
    # survey is the slot of plans themselves: its buffer has words that nothing writes
    slots = sorted({p["slot"] for p in passes} - {"survey"})
    for slot in draw.sample(slots, 2):
        state["use"][slot] = draw.choice([p["variant"] for p in passes if p["slot"] == slot] + ["none"])
    return state


def add_values(live, registry, state, draw):
    """Values of a few parameters that the state's pipeline has."""
    declared = {q["name"]: q for p in registry["passes"] for q in p["parameters"]}
    there = [q["name"] for slot in live.post("pipeline", state=state)["slots"] for q in slot["parameters"]]
    for name in draw.sample(there, min(6, len(there))):
        state["set"][name] = random_value(declared[name], draw)
    return state


def same_files(a, b):
    names = sorted(p.relative_to(a) for p in a.rglob("*.exr"))
    assert names and names == sorted(p.relative_to(b) for p in b.rglob("*.exr")), (names, a, b)
    return [str(n) for n in names if not filecmp.cmp(a / n, b / n, shallow=False)]


def check(live, folder, number, state):
    """What live writes, and what its command line writes; None where both refuse the state with the same words."""
    try:
        run = live.post("run", state=state)
    except Refused as refusal:
        command = live.post("pipeline", state=state)["command"]
        done = subprocess.run([GLINT, *shlex.split(command)[1:]], capture_output=True, text=True, cwd=folder)
        said = " ".join(done.stderr.split())
        assert done.returncode in (1, 2) and " ".join(refusal.message.split()) in said, (command, done.returncode, refusal.message, said)
        return None
    live.post("write", state=state, name=f"live{number}")
    ours = folder / f"command{number}"
    words = shlex.split(run["command"])
    words[words.index("-o") + 1] = str(ours)
    subprocess.run([GLINT, *words[1:]], check=True, capture_output=True, cwd=folder)
    theirs = folder / "runs" / f"live{number}"
    frames = [p for p in ours.iterdir() if p.is_dir()]
    if frames:  # of a shot the page writes its own frame alone
        (theirs,) = theirs.iterdir()
        ours = ours / theirs.name
    return same_files(theirs, ours)


def states_of(captures, presets, count, seed):
    draw, replayed = random.Random(seed), 0
    with tempfile.TemporaryDirectory() as name, Live(GLINT, *captures, "-o", pathlib.Path(name) / "runs") as live:
        registry = live.get("registry")
        tried = 0
        while replayed < count:
            tried += 1
            assert tried < 4 * count + 4, f"only {replayed} of {tried} states could be replayed"
            state = random_state(registry, presets or [p["name"] for p in registry["presets"]], draw)
            state["capture"] = len(captures) - 1 - tried % 2 if len(captures) > 1 else 0
            state = add_values(live, registry, state, draw)
            differing = check(live, pathlib.Path(name), tried, state)
            assert not differing, (state, differing)
            replayed += differing is not None
    print(f"# {replayed} states replayed, {tried - replayed} refused in the words of the command")


class Tests:
    def __init__(self, folder):
        self.folder = folder

    def sample(self, name, *options):
        tap.glint("sample", "street", "--light=1", "-o", str(self.folder / name), "--size", "64x36", "--cube-size", "16", *options)
        return sorted(p for p in self.folder.glob(name.replace(".exr", "*.exr")) if "cubemaps" not in p.name)

    def test_random_states_of_a_capture(self):
        states_of(self.sample("street.exr"), None, STATES, 24)

    def test_random_states_of_a_shot(self):
        frames = self.sample("shot.exr", "--frames", "4")
        states_of(frames, ["mafia3", "mafia_de_display"], SHOT_STATES, 25)


with tempfile.TemporaryDirectory() as work:
    sys.exit(tap.run(Tests(pathlib.Path(work))))
