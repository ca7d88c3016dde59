"""Shards of glint tune share out each round of evaluations, and make together what one process makes. rounds.py GLINT CAPTURES TRIES. Speaks TAP."""
import fcntl
import json
import os
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import tap
from timeless import contents

ARGUMENTS = ["set", "-o", "found.json", "-p", tap.PLAIN, "--budget-fetches", "60%", "--rays", "2", "--tries", sys.argv[3], "--repeat", "0", "--json",
             "--vary", "screen_trace.steps=2..64", "--vary", "cubemap_trace.steps_hq=4..64"]


class Tests:
    def __init__(self, folder):
        self.folder = folder
        for name in ("set", "one", "many"):
            os.mkdir(self.path(name))
        self.names = [f"set/{i}.exr" for i in range(int(sys.argv[2]))]
        for i, name in enumerate(self.names):
            tap.glint("sample", "still_life", "-o", name, "--size", f"{16 + 4 * i}x9", "--cube-size", "4", folder=folder)
        self.names.insert(1, "set/broken.exr")
        with open(self.path("set", "broken.exr"), "wb") as file:
            file.write(b"\x76\x2f\x31\x01 and no more")
        with open(self.path("set", "set.json"), "w", encoding="utf-8") as file:
            json.dump({"format": 1, "captures": [{"path": os.path.basename(name), "tags": [f"half-{i % 2}"]} for i, name in enumerate(self.names)]}, file)
        for name in ("one", "many"):
            os.symlink("../set", self.path(name, "set"))
        self.one = tap.glint("tune", *ARGUMENTS, folder=self.path("one"), status=1)
        self.whole = contents(self.path("one", "found.tune"))
        self.started = []

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def start(self, shard, *more):
        words = [os.path.abspath(sys.argv[1]), "tune", *ARGUMENTS, *more, "--shard", shard]
        self.started.append(subprocess.Popen(words, cwd=self.path("many"), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True))
        return self.started[-1]

    def log(self, number):
        return self.path("many", "found.tune", "shards", f"{number}-of-3", "log.jsonl")

    def lines(self, number):
        if not os.path.exists(self.log(number)):
            return []
        with open(self.log(number), encoding="utf-8") as file:
            return [line for line in file if line.endswith("\n")]

    def test_a_broken_capture_is_a_row(self):
        assert "left out: set/broken.exr" in self.one.stderr, self.one.stderr
        with open(self.path("one", "found.json"), encoding="utf-8") as file:
            captures = json.load(file)["provenance"]["captures"]
        broken = [name == "set/broken.exr" for name in self.names]
        assert [capture["xxh3_128"] is None for capture in captures] == broken, captures
        points = [line for line in self.whole["log.jsonl"] if "values" in line]
        assert 0 < len(points) <= int(sys.argv[3]) and all([one is None for one in line["captures"]] == broken for line in points)
        for line in points:  # what is left counts as if the broken one were not there
            assert all(one["error"] > 0 and one["cost"] > 0 for one in line["captures"] if one), line
        run = tap.glint("tune", "set/broken.exr", "set/broken.exr", *ARGUMENTS[1:2], "none.json", *ARGUMENTS[3:], folder=self.folder, status=2)
        assert "none of the 2 captures can be tuned on" in run.stderr and "broken.exr" in run.stderr, run.stderr
        assert not os.path.exists(self.path("none.json"))

    def test_figures_by_tag_and_the_worst_first(self):
        """Means of what is told of each capture, which are computed here once more."""
        found = json.loads(self.one.stdout)
        def errors(contender, names):
            return [row["contenders"][contender]["errors"]["all"]["value"] for row in found["confirmed"] if "contenders" in row and row["capture"] in names]
        assert [row["capture"] for row in found["confirmed"] if "broken" in row] == ["set/broken.exr"], found["confirmed"]
        groups = {group.get("tag"): group for group in found["overall"]}
        assert set(groups) == {None, "half-0", "half-1"}
        for tag, names in ((None, self.names), ("half-0", self.names[0::2]), ("half-1", self.names[1::2])):
            start, tuned = errors("start", names), errors("tuned", names)
            assert groups[tag]["captures"] == groups[tag]["shots"] == len(start) == len(names) - ("set/broken.exr" in names), groups[tag]
            for name, values in (("start", start), ("tuned", tuned), ("tuned_less_start", [b - a for a, b in zip(start, tuned)])):
                figure, mean = groups[tag][name], sum(values) / len(values) if values else None
                assert figure["value"] is None if mean is None else abs(figure["value"] - mean) < 1e-6, (tag, name, figure, mean)
                assert len(values) < 2 or figure["low"] <= figure["value"] <= figure["high"], figure
        titles = [section["title"] for section in self.whole["page.json"]["sections"]]
        shown = [title for title in titles if title.endswith(".exr")]
        worst = sorted((name for name in self.names if name != "set/broken.exr"), key=lambda name: -errors("tuned", [name])[0])
        assert shown == [os.path.basename(name) for name in worst], (shown, worst)

    def test_shards_make_what_one_process_makes(self):
        """Two run at the same time, until one is killed in the middle, and the other goes on alone; the third is started when all is done."""
        killed = self.waits_for_locks(2)
        second = self.start("1/3")
        while killed.poll() is None and len(self.lines(1)) + len(self.lines(2)) < len(self.names) + (len(self.names) - 1) * int(sys.argv[3]) // 2:
            time.sleep(0.002)
        killed.send_signal(signal.SIGKILL)
        assert killed.wait() in (-signal.SIGKILL, 0), killed.stderr.read()  # 0: it was faster
        before = self.lines(2)
        with open(self.log(2), "ab") as file:
            file.write(b'{"error":0.1,"cost":2,"capture":0,"val')  # as a kill in the middle of a write leaves it
        assert second.wait() == 0, second.stderr.read()
        run = tap.glint("merge", "many/found.tune", folder=self.folder, status=2)
        assert "is not done" in run.stderr or "missing" in run.stderr, run.stderr
        again, third = self.start("2/3"), self.start("3/3")
        assert again.wait() == 0 and third.wait() == 0, (again.stderr.read(), third.stderr.read())
        assert self.lines(2) == before and not self.lines(3)
        works = [json.dumps([line["capture"], line.get("values")]) for number in (1, 2, 3) for line in map(json.loads, self.lines(number))]
        points = sum("values" in line for line in self.whole["log.jsonl"])
        assert len(works) == len(set(works)) == len(self.names) + (len(self.names) - 1) * points, works
        merged = tap.glint("merge", "found.tune", "--json", folder=self.path("many"), status=1)
        assert json.loads(merged.stdout)["fresh"] == 0, "evaluated again"
        assert "left out: set/broken.exr" in merged.stderr, merged.stderr
        found = contents(self.path("many", "found.tune"), "shards")
        assert found.keys() == self.whole.keys(), found.keys() ^ self.whole.keys()
        differing = [name for name in found if found[name] != self.whole[name]]
        assert not differing, differing
        with open(self.path("many", "found.json"), "rb") as file, open(self.path("one", "found.json"), "rb") as other:
            assert file.read() == other.read()
        self.other_searches_are_refused()

    def waits_for_locks(self, number):
        """The shard, started while somebody else works on all that there is to do: it does nothing before that ends."""
        folder = self.path("many", "found.tune", "shards")
        os.makedirs(folder)
        with open(os.path.join(folder, "claims"), "wb") as claims:
            fcntl.lockf(claims, fcntl.LOCK_EX)
            process = self.start(f"{number}/3")
            while process.poll() is None and not os.path.exists(self.log(number)):
                time.sleep(0.01)
            said = b""
            while b"waiting for" not in said and process.poll() is None:
                process.send_signal(signal.SIGUSR1)  # so that it prints its progress
                if select.select([process.stderr], [], [], 0.05)[0]:
                    said += os.read(process.stderr.fileno(), 4096)
            assert b"waiting for" in said and not self.lines(number), (said, self.lines(number))
        return process

    def other_searches_are_refused(self):
        shutil.rmtree(self.path("many", "found.tune", "shards", "3-of-3"))
        other = self.start("3/3", "--rays", "3")
        assert other.wait() != 0
        assert "other arguments" in other.stderr.read()

    def finish(self):
        for process in self.started:
            process.kill()
            process.communicate()


def main():
    sys.argv[1] = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="glint-rounds-") as folder:
        tests = Tests(folder)
        try:
            return tap.run(tests)
        finally:
            tests.finish()


sys.exit(main())
