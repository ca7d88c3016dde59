"""A long shot grows nothing: long_shot.py GLINT LAYER-FOLDER HEAP-LIBRARY [--frames N] [--size WxH] … Speaks TAP.

Replays a shot of many frames with history, and looks every few frames at the process: what glint's threads hold of the heap, memory, open files, threads and Vulkan
objects, and the time that a frame took. A line is fitted to each; it has to be level within the noise. Then another process replays the first frames of the shot again, is killed in the
middle, and resumed: every image has to be the same, bit for bit."""
import argparse
import hashlib
import os
import pathlib
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("glint", type=os.path.abspath)
parser.add_argument("layers", help="the folder with the layer VK_LAYER_GLINT_fault", type=os.path.abspath)
parser.add_argument("heap", help="the library of live_heap.c", type=os.path.abspath)
parser.add_argument("--frames", type=int, default=2000)
parser.add_argument("--size", default="240x135")
parser.add_argument("--cube-size", default="16")
parser.add_argument("--every", type=int, default=50, help="frames between two looks")
parser.add_argument("--distinct", type=int, default=16, help="frames that are rendered; the others repeat them, over and over, under their own numbers")
parser.add_argument("--resumed", type=int, help="frames of the shot that is killed and resumed (a fifth)")
parser.add_argument("--preset", default="mafia_de")
parser.add_argument("--time", action="store_true", help="judge the time of a frame, too: only where nothing else runs")
parser.add_argument("--folder", help="where the shot and its runs are kept (a temporary folder)")
given = parser.parse_args()
NUMBER = b"glint.frame\0int\0\4\0\0\0"


def number_of_frame(path):
    data = path.read_bytes()
    at = data.index(NUMBER) + len(NUMBER)
    return int.from_bytes(data[at:at + 4], "little")


def make_shot(folder):
    """Frames in order, of which few are rendered. The number of a frame is a whole number in its header."""
    rendered = folder / "rendered"
    rendered.mkdir(parents=True, exist_ok=True)
    subprocess.run([given.glint, "sample", "street", "-o", rendered / "s.exr", "--size", given.size, "--cube-size", given.cube_size, "--frames", str(given.distinct)],
                   check=True, stderr=subprocess.DEVNULL)
    sources = sorted(rendered.glob("s.[0-9]*.exr"))
    first = number_of_frame(sources[0])
    shot = folder / "shot"
    shot.mkdir(exist_ok=True)
    for shared in rendered.glob("s.cubemaps.exr"):
        (shot / shared.name).write_bytes(shared.read_bytes())
    frames = []
    for i in range(given.frames):
        data = sources[i % len(sources)].read_bytes()
        assert data.count(NUMBER) >= 1, "no frame number in the capture"
        frames.append(shot / f"f{i:05}.exr")
        frames[-1].write_bytes(re.sub(re.escape(NUMBER) + b"....", lambda m: NUMBER + (first + i).to_bytes(4, "little"), data, flags=re.S))
    return frames


def status_of(pid):
    """Resident memory in bytes, threads, and open files."""
    with open(f"/proc/{pid}/status", encoding="utf-8") as file:
        values = dict(line.split(":", 1) for line in file)
    return int(values["RssAnon"].split()[0]) * 1024, int(values["Threads"]), len(os.listdir(f"/proc/{pid}/fd"))


class Shot:
    """A replay under way."""

    def __init__(self, frames, out, live, *more):
        environment = {**os.environ, "VK_LAYER_PATH": given.layers, "VK_INSTANCE_LAYERS": "VK_LAYER_GLINT_fault", "LD_PRELOAD": given.heap, "GLINT_FAULT_LIVE": str(live),
                       "GLINT_CACHE": "none"}
        self.frames, self.out, self.live = frames, out, live
        self.said = tempfile.TemporaryFile()
        self.process = subprocess.Popen([given.glint, "replay", *frames, "-o", out, "--preset", given.preset, "--outputs", "composed", *more], env=environment,
                                        stdout=subprocess.DEVNULL, stderr=self.said)

    def done(self, i):
        return (self.out / self.frames[i].stem / "run.json").exists()

    def wait_for(self, i):
        """Until frame i is complete, or the process has ended. The objects and bytes that the layer told last, and the least that glint held: a frame takes and gives back."""
        objects, heap, least = 0, 0, None
        while not self.done(i) and self.process.poll() is None:
            time.sleep(0.001)
            words = self.live.read_text().split() if self.live.exists() else []
            if len(words) == 3:  # else it is just being written
                objects, heap, held = map(int, words)
                least = held if least is None else min(least, held)
        return objects, heap, least

    def finish(self):
        status = self.process.wait()
        self.said.seek(0)
        said = self.said.read().decode()
        assert status == 0 and "without history" not in said and "fault layer" not in said, (status, said[-2000:])


def fit(points):
    """Slope of a line through (x, y), its standard error, and the middle of y. By medians (Theil and Sen): a look may come in the middle of something."""
    slope = statistics.median((y - v) / (x - u) for k, (x, y) in enumerate(points) for u, v in points[:k])
    middle = statistics.median(x for x, _ in points)
    level = statistics.median(y - slope * (x - middle) for x, y in points)
    noise = 1.4826 * statistics.median(abs(y - level - slope * (x - middle)) for x, y in points)
    return slope, noise / sum((x - middle) ** 2 for x, _ in points) ** 0.5, level


# What is looked at, its unit, and how much of it a frame may take for good, which is less than any leak of that kind. The heap has the driver's objects, too, and what
# threads keep of freed blocks for themselves, which grows by some hundred bytes a frame for the first hundred. A page is the least that memory grows by.
KINDS = [("held by glint", "bytes", 64), ("heap", "bytes", 1024), ("anonymous memory", "bytes", 4096), ("threads", "", 0.005), ("open files", "", 0.005), ("Vulkan objects", "", 0.005)]


class Tests:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.frames = make_shot(self.folder)

    def judge(self, name, unit, points, least):
        """The first fifth warms up. What grows by more than noise does, and by more than `least` a frame, is a leak."""
        points = [p for p in points if p[0] >= given.frames / 5]
        slope, error, level = fit(points)
        print(f"# {name}: {level:.6g} {unit}, {slope:+.3g} ± {error:.2g} a frame, {slope * given.frames:+.3g} over the shot".replace("  ", " "), flush=True)
        return [] if slope <= least or slope <= 5 * error else [f"{name}: {slope:+.3g} ± {error:.2g} {unit} a frame, at {level:.6g}"]

    def test_1_nothing_grows(self):
        shot = Shot(self.frames, self.folder / "whole", self.folder / "live")
        looks, times, last = [], [], time.monotonic()
        for i in range(given.every - 1, given.frames, given.every):
            objects, heap, held = shot.wait_for(i)
            now = time.monotonic()
            times.append((i, (now - last) / given.every))
            last = now
            try:
                memory, threads, files = status_of(shot.process.pid)
            except (OSError, KeyError):  # it has ended
                continue
            if held is not None:
                looks.append((i, held, heap, memory, threads, files, objects))
        shot.finish()
        assert len(looks) >= 8 and all(held for _, held, *_ in looks), looks
        grown = []
        for k, (name, unit, least) in enumerate(KINDS, 1):
            grown += self.judge(name, unit, [(look[0], look[k]) for look in looks], least)
        slow = self.judge("time of a frame", "s", times, 1e-6)
        assert not grown and not (slow and given.time), (grown, slow)
        numbers = [shot.done(i) for i in range(given.frames)]
        assert all(numbers), numbers.count(False)

    def images(self, out, count):
        return {f"{frame.stem}/{image.name}": hashlib.sha256(image.read_bytes()).hexdigest()
                for frame in self.frames[:count] for image in (out / frame.stem).glob("*.exr")}

    def test_2_resumed_in_the_middle_it_is_the_same_bit_for_bit(self):
        count = given.resumed or max(8, given.frames // 5)
        out, live = self.folder / "resumed", self.folder / "live2"
        shot = Shot(self.frames[:count], out, live)
        # Not where the frames begin anew: the history of another camera is refused when it is read from a folder.
        shot.wait_for(count // 2 // given.distinct * given.distinct + given.distinct // 2)
        shot.process.send_signal(signal.SIGKILL)
        shot.process.wait()
        kept = sum(shot.done(i) for i in range(count))
        assert count // 4 < kept < count, f"killed too late: {kept} of {count}"
        Shot(self.frames[:count], out, live).finish()  # the same command goes on
        expected, found = self.images(self.folder / "whole", count), self.images(out, count)
        assert expected and expected == found, [name for name in {*expected, *found} if expected.get(name) != found.get(name)][:5]
        print(f"# killed after {kept} of {count} frames; {len(found)} images are the same")


if given.folder:
    os.makedirs(given.folder, exist_ok=True)
    sys.exit(tap.run(Tests(given.folder)))
with tempfile.TemporaryDirectory(prefix="glint-long-shot-") as work:
    sys.exit(tap.run(Tests(work)))
