"""glint batch with a real Slurm of one node: slurm.py GLINT. Speaks TAP. Half an hour on two cores, most of it for processes of two sweeps of 1,200 results."""
import functools
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile

import one_node
from one_node import until
import tap
from tap import glint
import timeless

GLINT = sys.argv[1] = os.path.abspath(sys.argv[1])
CAPTURES, POINTS, SHARDS = 60, 20, 8
SWEEP = ["-p", tap.PLAIN, "--reference", "truth", "--repeat", "0", "--vary", f"cubemap_trace.steps_hq=1..{POINTS}"]
# What glint batch adds to what one process writes.
OWN = ("shards", "logs", "batch.json", "shard.sbatch", "merge.sbatch")


def lines(path):
    """The whole lines of a journal."""
    if not os.path.exists(path):
        return []
    with open(path, "rb") as file:
        return [line for line in file if line.endswith(b"\n")]


def process_of(out, shard):
    """The process that works on the shard, and no shell that is about to become it."""
    for process in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{process}/cmdline", "rb") as file:
                words = file.read().split(b"\0")
        except OSError:  # it has ended
            continue
        if words[:2] == [GLINT.encode(), b"sweep"] and f"--shard={shard}/{SHARDS}".encode() in words and f"--output={out}".encode() in words:
            return int(process)
    return None


class Tests:
    def __init__(self, folder, slurm):
        self.slurm = slurm
        os.environ.update(slurm.environment)
        os.chdir(folder)

    @functools.cached_property
    def shot(self):
        os.mkdir("shot")
        glint("sample", "room", "-o", "shot/room.exr", f"--frames={CAPTURES}", "--size=16x9", "--cube-size=8", "--light=1", "--truth=1")
        return "shot"

    @functools.cached_property
    def whole(self):
        """What one process makes."""
        glint("sweep", self.shot, "-o", "whole", *SWEEP)
        found = timeless.contents("whole")
        assert len(found["log.jsonl"]) == CAPTURES * POINTS
        return found

    def status(self, out):
        return json.loads(glint("batch", "status", out, "--json").stdout)

    def wait(self, out):
        """Until nothing of it is in the queue; what the status then is."""
        def ended():
            found = self.status(out)
            active = [job["state"] for job in [*found["shards"], found["merge"]] if job["state"] in ("pending", "running", "completing")]
            return None if active else found
        return until(f"the end of {out}", ended, 1800)

    def control(self, state):
        subprocess.run(["scontrol", "update", f"nodename={self.slurm.host}", f"state={state}", "reason=test"], check=True)

    def check_same(self, out):
        found = timeless.contents(out, *OWN)
        assert found.keys() == self.whole.keys(), found.keys() ^ self.whole.keys()
        differing = [name for name in found if found[name] != self.whole[name]]
        assert not differing, differing
        counted = [(line["capture"], line["point"]) for k in range(SHARDS) for line in map(json.loads, lines(f"{out}/shards/{k + 1}-of-{SHARDS}/log.jsonl"))]
        assert len(counted) == len(set(counted)) == CAPTURES * POINTS, len(counted)

    def logs(self, out):
        text = ""
        for name in sorted(os.listdir(f"{out}/logs")):
            with open(f"{out}/logs/{name}", encoding="utf-8", errors="replace") as file:
                text += f"{name}: {file.read()[-300:]}\n"
        return text

    def test_merged_shards_are_what_one_process_makes(self):
        glint("batch", "sweep", self.shot, "-o", "straight", *SWEEP, "--slurm", f"--shards={SHARDS}", "--partition=all", "--sbatch=--time=1:00:00")
        found = self.wait("straight")
        assert found["merge"]["done"] and found["merge"]["state"] == "completed", (found, self.logs("straight"))
        assert {s["state"] for s in found["shards"]} == {"completed"} and found["results"] == CAPTURES * POINTS and not found["missing"], found
        self.check_same("straight")
        assert "merged" in glint("batch", "resubmit", "straight").stdout

    def test_a_killed_shard_and_a_drained_node(self):
        """A shard is killed in the middle. The node is drained: what runs ends, what waits waits. Then only the killed one is submitted again."""
        glint("batch", "sweep", self.shot, "-o", "killed", *SWEEP, "--slurm", f"--shards={SHARDS}")
        log = f"killed/shards/2-of-{SHARDS}/log.jsonl"
        until("some results", lambda: len(lines(log)) >= 3)
        process = process_of("killed", 2)
        os.kill(process, signal.SIGSTOP)  # so that it is in the middle, however long the node takes to be told
        self.control("drain")
        os.kill(process, signal.SIGKILL)
        until("the end of the killed one", lambda: self.status("killed")["shards"][1]["state"] == "failed")
        before = lines(log)
        assert 3 <= len(before) < self.status("killed")["shards"][1]["of"], "it was killed in the middle"
        until("a drained node", lambda: self.slurm.says("sinfo", "-h", "-o", "%T").startswith("drained"))
        found = self.status("killed")
        waiting = [s["shard"] for s in found["shards"] if s["state"] == "pending"]
        assert found["missing"] == [2] and waiting and not found["merge"]["done"], found
        said = glint("batch", "resubmit", "killed").stdout
        assert f"shards 2 of {SHARDS}" in said, said
        assert self.status("killed")["missing"] == [] and "nothing is missing" in glint("batch", "resubmit", "killed").stdout
        assert not process_of("killed", 2) and lines(log) == before, "the node takes no job"
        self.control("resume")
        found = self.wait("killed")
        assert found["merge"]["done"] and found["merge"]["state"] == "completed", (found, self.logs("killed"))
        assert lines(log)[:len(before)] == before, "what it had is not done again"
        self.check_same("killed")

    def test_other_commands_in_shards(self):
        """Of the merge of a lint with findings Slurm says that it failed, since its exit status is that of lint."""
        os.mkdir("few")
        for name in sorted(name for name in os.listdir(self.shot) if name.startswith("room.0"))[:6]:
            shutil.copy(f"{self.shot}/{name}", "few")
        shutil.copy(f"{self.shot}/room.cubemaps.exr", "few")
        with open("few/unreadable.exr", "wb") as file:
            file.write(b"not an image")
        compare = ["--presets", tap.PLAIN, "--effect", "reflection", "--repeat", "1"]
        for command, words, state in (("lint", [], "failed"), ("validate", [], "failed"), ("compare", compare, "failed")):
            glint(command, "few", "-o", f"{command}-one", *words, status=1)
            glint("batch", command, "few", "-o", f"{command}-out", *words, "--slurm", "--shards=3")
            found = self.wait(f"{command}-out")
            assert found["merge"]["done"] and found["merge"]["state"] == state and found["results"] == 7, (found, self.logs(f"{command}-out"))
            assert f"merged: {command}-out" in glint("batch", "status", f"{command}-out").stdout
            one, out = timeless.contents(f"{command}-one"), timeless.contents(f"{command}-out", *OWN)
            timed = ("index.html", "page.json", "table.csv")
            assert one.keys() == out.keys() and not [name for name in one if one[name] != out[name] and name not in timed], (one.keys(), out.keys())

    def test_a_search_in_rounds(self):
        """More shards than run at a time: those that wait in the queue are not waited for. The result is that of one process, but for the command that it names."""
        frames = sorted(f"shot/{name}" for name in os.listdir(self.shot) if name.startswith("room.0"))[:3]
        words = ["tune", *frames, "-o", "half.json", "-p", tap.PLAIN, "--budget-fetches", "60%", "--reference", "truth", "--tries", "20", "--repeat", "0",
                 "--vary", "screen_trace.steps=2..64", "--vary", "cubemap_trace.steps_hq=4..64"]
        found = {}
        for name in ("one", "many"):
            os.makedirs(f"rounds/{name}")
            os.symlink("../../shot", f"rounds/{name}/shot")
        glint(*words, folder="rounds/one")
        glint("batch", *words, "--slurm", "--shards=4", folder="rounds/many")
        status = self.wait("rounds/many/half.tune")
        assert status["merge"]["done"] and {s["state"] for s in status["shards"]} == {"completed"}, (status, self.logs("rounds/many/half.tune"))
        for name in ("one", "many"):
            with open(f"rounds/{name}/half.json", encoding="utf-8") as file:
                found[name] = {**timeless.contents(f"rounds/{name}/half.tune", *OWN), "preset": json.load(file)}
            found[name]["preset"]["provenance"].pop("command")
            found[name]["page.json"]["facts"] = [fact for fact in found[name]["page.json"]["facts"] if "command" not in fact]
            found[name].pop("half.html")
        assert found["one"].keys() == found["many"].keys(), found["one"].keys() ^ found["many"].keys()
        differing = [name for name in found["one"] if found["one"][name] != found["many"][name]]
        assert not differing, differing
        counted = [(line["capture"], str(line.get("values"))) for k in range(4) for line in map(json.loads, lines(f"rounds/many/half.tune/shards/{k + 1}-of-4/log.jsonl"))]
        assert len(counted) == len(set(counted)) == status["results"], counted

    def test_a_cancelled_batch_goes_on(self):
        """Names are hard, and scripts are changed before they are submitted."""
        odd = "odd 'x' \"y\" $z\n"
        os.mkdir(odd)
        first, second = sorted(name for name in os.listdir(self.shot) if name.startswith("room.0"))[:2]
        shutil.copytree(self.shot, f"{odd}/%j \\n")
        out = f"{odd}/out #1"
        glint("batch", "sweep", f"%j \\n/{first}", f"%j \\n/{second}", "-o", "out #1", *SWEEP, "--slurm", "--no-submit", "--shards=2", '--sbatch=--comment=say "a\\b" #1',
              folder=odd)
        with open(f"{out}/shard.sbatch", "r+", encoding="utf-8") as file:
            text = file.read().replace("#SBATCH --ntasks=1", "#SBATCH --ntasks=1\n#SBATCH --hold")
            file.seek(0)
            file.write(text)
        glint("batch", "resubmit", out)
        found = self.status(out)
        assert [s["reason"] for s in found["shards"]] == ["JobHeldUser"] * 2 and found["merge"]["state"] == "pending", found
        assert 'Comment=say "a\\b" #1' in self.slurm.says("scontrol", "show", "job", found["merge"]["job"])
        glint("batch", "cancel", out)
        found = self.wait(out)
        assert [s["state"] for s in found["shards"]] == ["cancelled"] * 2 and found["missing"] == [1, 2] and found["merge"]["state"] == "cancelled", found
        with open(f"{out}/shard.sbatch", "w", encoding="utf-8") as file:
            file.write(text.replace("#SBATCH --hold\n", ""))
        glint("batch", "resubmit", out)
        found = self.wait(out)
        assert found["merge"]["done"] and found["results"] == 2 * POINTS, (found, self.logs(out))
        assert len([name for name in os.listdir(f"{out}/logs") if name.startswith("shard-")]) == 2, os.listdir(f"{out}/logs")

    def test_a_merge_of_shards_that_failed_does_not_stay_in_the_queue(self):
        glint("batch", "sweep", "nothing.exr", "-o", "failed", *SWEEP, "--slurm", "--shards=2")
        found = self.wait("failed")
        assert [s["state"] for s in found["shards"]] == ["failed"] * 2 and found["merge"]["state"] == "cancelled", found
        assert "nothing.exr" in glint("batch", "status", "failed").stdout


def main():
    with tempfile.TemporaryDirectory(prefix="glint-slurm-") as folder:
        os.mkdir(os.path.join(folder, "slurm"))
        os.mkdir(os.path.join(folder, "work"))
        with one_node.OneNode(os.path.join(folder, "slurm")) as slurm:
            return tap.run(Tests(os.path.join(folder, "work"), slurm))


if __name__ == "__main__":
    sys.exit(main())
