"""Sweeps in shards: glint merge makes of them what one process makes, and refuses what is not whole. shards.py GLINT [all]. Speaks TAP. `all` traces references."""
import glob
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import tap
from timeless import contents

SCENES = ["room", "still_life"]
ALL = sys.argv[2:] == ["all"]
SPACE = ["-p", tap.PLAIN, "--vary", "screen_trace.steps=4,8,16", "--repeat", "0"]
ARGUMENTS = SPACE + (["--rays", "4"] if ALL else ["--reference", "truth"])
CACHE = ("--cache", "cache")


class Tests:
    def __init__(self, folder):
        self.folder = folder
        for name in ("set", "uneven"):
            os.mkdir(self.path(name))
        for scene in SCENES:
            tap.glint("sample", scene, "-o", f"set/{scene}.exr", "--size", "16x9", "--cube-size", "4", "--light", "1", "--truth", "1", folder=folder)
        self.glint("sweep", "set", "-o", "whole", *ARGUMENTS)
        self.whole = contents(self.path("whole"))
        assert len(self.whole["log.jsonl"]) == 6 and len([name for name in self.whole if name.startswith("pictures/")]) > 6
        self.sweep("cut", 2, more=CACHE)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def glint(self, *words, status=0):
        return tap.glint(*words, folder=self.folder, status=status)

    def sweep(self, out, count, numbers=None, more=()):
        for number in numbers or range(1, count + 1):
            self.glint("sweep", "set", "-o", out, *ARGUMENTS, *more, "--shard", f"{number}/{count}")

    def check_same(self, found):
        assert found.keys() == self.whole.keys(), found.keys() ^ self.whole.keys()
        differing = [name for name in found if found[name] != self.whole[name]]
        assert not differing, differing

    def copy(self, name):
        shutil.rmtree(self.path(name), ignore_errors=True)
        shutil.copytree(self.path("cut"), self.path(name))
        return [self.path(name, "shards", f"{i}-of-2") for i in (1, 2)]

    def refused(self, words, *arguments, status=1):
        run = self.glint("merge", *arguments, status=status)
        assert all(word in run.stderr for word in words), run.stderr

    def test_merged_shards_are_what_one_process_makes(self):
        self.copy("merged")
        for _ in range(1 + ALL):  # also once more
            self.glint("merge", "merged")
            self.check_same(contents(self.path("merged"), "shards"))

    def test_shards_share_the_work(self):
        logs = []
        for number in (1, 2):
            with open(self.path("cut", "shards", f"{number}-of-2", "log.jsonl"), encoding="utf-8") as file:
                logs.append({(line["capture"], line["point"]) for line in map(json.loads, file)})
        assert not logs[0] & logs[1] and len(logs[0] | logs[1]) == 6 and min(map(len, logs)) == 3, logs

    def killed(self, arguments, file, ready):
        """Starts a process, and kills it when the file is ready; whether it was not done before."""
        words = [os.path.abspath(sys.argv[1]), *arguments]
        process = subprocess.Popen(words, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and not (os.path.exists(file) and ready(file)):
            time.sleep(0.002)
        process.send_signal(signal.SIGKILL)
        process.wait()
        return process.returncode != 0

    def results_of(self, number):
        """How many results a share of the uneven captures has, as it says before it begins."""
        record = self.path("uneven-cut", "shards", f"{number}-of-2", "shard.json")
        self.killed(["sweep", "uneven", "-o", "uneven-cut", *SPACE, "--rays", "4", "--no-pictures", "--shard", f"{number}/2"], record, os.path.getsize)
        with open(record, encoding="utf-8") as file:
            return json.load(file)["results"]

    def test_shards_are_cut_by_their_cost(self):
        """A capture of many pixels takes the share of many small ones, and is not cut in its last part, whose reference would be traced twice."""
        tap.glint("sample", "room", "-o", "uneven/a.exr", "--size", "48x27", "--cube-size", "4", "--light", "1", folder=self.folder)
        for i in range(4):
            shutil.copy(self.path("set", "room.exr"), self.path("uneven", f"b{i}.exr"))
        assert [self.results_of(number) for number in (1, 2)] == [3, 12]

    def traced(self, out):
        """{REFERENCE: how long it took to trace it}"""
        found = {}
        for path in glob.glob(self.path(out, "shards", "*", "reflection-*", "run.json")):
            with open(path, encoding="utf-8") as file:
                found[path.split(os.sep)[-2]] = json.load(file)["reference"]["seconds"]
        return found

    if ALL:
        def test_more_shards_than_captures(self):
            """They find the references that other shards traced in the cache."""
            self.sweep("many", 4, more=CACHE)
            cut, many = self.traced("cut"), self.traced("many")
            assert len(cut) == len(SCENES) and cut == many, (cut, many)
            self.refused(["shard.json"], "many/shards", "-o", "of-many")  # which is none
            shards = sorted(os.listdir(self.path("many", "shards")), reverse=True)
            self.glint("merge", *(f"many/shards/{name}" for name in shards), "-o", "of-many")
            self.check_same(contents(self.path("of-many"), "shards"))

    def test_a_killed_shard_goes_on(self):
        first, second = self.copy("killed")
        log = os.path.join(second, "log.jsonl")
        shutil.rmtree(second)
        if self.killed(["sweep", "set", "-o", "killed", *ARGUMENTS, "--shard", "2/2"], log, os.path.getsize):
            self.refused(["shard 2 of 2 is not done"], "killed", status=2)
        with open(log, "ab") as file:
            file.write(b'{"capture": 2, "poi')  # as a kill in the middle of a write leaves it
        self.sweep("killed", 2, [2])
        found, undisturbed = (contents(folder, "shard.json") for folder in (second, self.path("cut", "shards", "2-of-2")))
        assert found.keys() == undisturbed.keys() and found["log.jsonl"] == undisturbed["log.jsonl"] and len(found["log.jsonl"]) == 3, found.keys()
        self.glint("merge", "killed", "--journal-only")
        assert contents(self.path("killed"))["log.jsonl"] == self.whole["log.jsonl"]

    def test_what_is_not_whole_is_refused(self):
        first, second = self.copy("bad")
        self.refused(["shard 2 of 2 is missing"], first, "-o", "no", status=2)
        self.refused(["shard 1 of 2 is missing"], second, "-o", "no", status=2)
        shutil.copytree(first, self.path("again"))
        self.refused(["both are shard 1 of 2"], first, "again", second, "-o", "no", status=2)
        self.refused(["-o FOLDER"], first, second, status=2)
        self.sweep("other", 3, [2])
        self.refused(["expected one of 2 shards", "one of 3"], first, "other/shards/2-of-3", "-o", "no", status=2)
        assert not os.path.exists(self.path("no"))

    def change(self, path, change):
        with open(path, encoding="utf-8") as file:
            content = json.load(file)
        change(content)
        with open(path, "w", encoding="utf-8") as file:
            json.dump(content, file)

    def test_shards_of_strangers_are_refused(self):
        first, second = self.copy("strange")
        self.change(os.path.join(second, "sweep.json"), lambda content: content.update(repeat=5))
        self.refused(["differs from that of"], "strange", status=2)
        first, second = self.copy("strange")
        for shard in (first, second):
            self.change(os.path.join(shard, "shard.json"), lambda content: content.update(command="pack"))
            os.rename(os.path.join(shard, "sweep.json"), os.path.join(shard, "pack.json"))
        self.refused(["a command with --shard, found pack"], "strange")
        for line, word in ((b"{}\n", "expected a line"), (b'{"capture": -1, "point": 0}\n', "expected a line"), (b"no JSON\n", "expected a line")):
            first, second = self.copy("strange")
            with open(os.path.join(second, "log.jsonl"), "ab") as file:
                file.write(line)
            self.refused([word], "strange")
        first, second = self.copy("strange")
        with open(os.path.join(second, "log.jsonl"), "rb") as file:
            line = file.readlines()[-1]
        with open(os.path.join(second, "log.jsonl"), "ab") as file:
            file.write(line)
        self.refused(["there twice"], "strange")
        first, second = self.copy("strange")
        picture = os.path.join(second, "pictures", os.listdir(os.path.join(second, "pictures"))[0])
        os.remove(picture)
        os.symlink("/dev/zero", picture)
        self.refused([os.path.basename(picture), "expected a file"], "strange")
        first, second = self.copy("strange")
        os.remove(os.path.join(second, "log.jsonl"))
        os.mkfifo(os.path.join(second, "log.jsonl"))
        self.refused(["log.jsonl"], "strange")


def main():
    sys.argv[1] = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="glint-shards-") as folder:
        return tap.run(Tests(folder))


sys.exit(main())
