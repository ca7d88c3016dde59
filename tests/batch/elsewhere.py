"""The recipes of docs/batch.md for shards without Slurm, run as they are printed: elsewhere.py GLINT PAGE. Speaks TAP."""
import os
import re
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap  # noqa: E402
from tap import glint, programs  # noqa: E402
import timeless  # noqa: E402

GLINT = sys.argv[1] = os.path.abspath(sys.argv[1])
PAGE = os.path.abspath(sys.argv[2])


class Tests:
    def __init__(self, folder):
        with open(PAGE, encoding="utf-8") as file:
            without = file.read().partition("## Without Slurm")[2]
        self.recipes = dict(re.findall(r"```(\w+)\n(.*?)```", without, re.S))
        assert sorted(self.recipes) == ["sh", "yaml"] and all(text.count("\n") <= 10 for text in self.recipes.values())
        self.folder = folder
        os.mkdir(os.path.join(folder, "bin"))
        os.symlink(GLINT, os.path.join(folder, "bin/glint"))
        os.environ["PATH"] = os.path.join(folder, "bin") + ":" + os.environ["PATH"]
        os.environ["HOME"] = folder  # where parallel keeps its settings
        os.makedirs(os.path.join(folder, "whole/shots"))
        for scene in ("street", "room"):
            glint("sample", scene, "--light=1", "-o", f"whole/shots/{scene}.exr", "--size=16x9", "--cube-size=8", folder=folder)
        for name in ("parallel", "kubernetes"):
            os.mkdir(os.path.join(folder, name))
            os.symlink("../whole/shots", os.path.join(folder, name, "shots"))
        command = re.search(r"glint (sweep .*) --shard", self.recipes["sh"])[1].split()
        glint(*command, folder=os.path.join(folder, "whole"))
        self.whole = timeless.contents(os.path.join(folder, "whole/steps"))

    def check_same(self, name):
        """But for times, and for the points of fronts and their pictures, which times choose."""
        found, whole = timeless.contents(os.path.join(self.folder, name, "steps"), "shards"), self.whole
        assert {"index.html", "points.json", "log.jsonl"} <= found.keys() and found["sweep.json"] == whole["sweep.json"], found.keys()
        places = [[(line["capture"], line["point"], line.get("round")) for line in kept["log.jsonl"]] for kept in (found, whole)]
        results = [[line for line in kept["log.jsonl"] if "round" not in line] for kept in (found, whole)]
        assert places[0] == places[1] and results[0] == results[1] and (len(places[0]), len(results[0])) == (32, 8), places

    def test_gnu_parallel(self):
        programs.find("parallel")
        for _ in range(2):  # the second time nothing is left to do
            subprocess.run(["bash", "-e", "-c", self.recipes["sh"]], cwd=os.path.join(self.folder, "parallel"), check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(self.folder, "parallel/steps.jobs"), encoding="utf-8") as file:
            assert len(file.readlines()) == 1 + 8
        self.check_same("parallel")

    def test_kubernetes(self):
        programs.module("yaml")
        import yaml
        job = yaml.safe_load(self.recipes["yaml"])
        assert job["apiVersion"] == "batch/v1" and job["kind"] == "Job" and job["spec"]["completionMode"] == "Indexed", job
        pod = job["spec"]["template"]["spec"]
        (container,) = pod["containers"]
        assert {mount["name"] for mount in container["volumeMounts"]} == {volume["name"] for volume in pod["volumes"]}
        assert container["workingDir"] == container["volumeMounts"][0]["mountPath"]
        folder = os.path.join(self.folder, "kubernetes")
        for index in range(job["spec"]["completions"]):
            subprocess.run(container["command"], cwd=folder, check=True, stdout=subprocess.DEVNULL, env={**os.environ, "JOB_COMPLETION_INDEX": str(index)})
        glint("merge", "steps", folder=folder)
        self.check_same("kubernetes")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="glint-elsewhere-") as scratch:
        sys.exit(tap.run(Tests(scratch)))
