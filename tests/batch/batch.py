"""glint batch with stand-ins of Slurm's programs, which note how they were called: batch.py GLINT. Speaks TAP. slurm.py has the real ones."""
import json
import os
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap  # noqa: E402
from tap import glint  # noqa: E402

GLINT = sys.argv[1] = os.path.abspath(sys.argv[1])
# Each call becomes a line: the program, its folder, its words. What it prints and how it ends is in files: sbatch counts jobs up.
FAKE = """#!/bin/sh
name=${0##*/}
{ printf '%s\\t%s' "$name" "$PWD"; printf '\\t%s' "$@"; echo; } >>"$FAKES/calls"
[ "$name" != sbatch ] || [ -f "$FAKES/sbatch.says" ] || { job=$(($(cat "$FAKES/job") + 1)); echo $job >"$FAKES/job"; echo $job; }
[ ! -f "$FAKES/$name.says" ] || cat "$FAKES/$name.says"
[ ! -f "$FAKES/$name.fails" ] || { cat "$FAKES/$name.fails" >&2; exit 1; }
"""
WORDS = """#!/bin/sh
printf '%s\\0' "$PWD" "$@" >"$FAKES/given"
"""


class Tests:
    def __init__(self, folder):
        self.folder, self.fakes, self.batches = folder, os.path.join(folder, "fakes"), 0
        os.makedirs(self.fakes)
        for name, text in [(name, FAKE) for name in ("sbatch", "squeue", "sacct", "scancel")] + [("words", WORDS)]:
            with open(os.open(os.path.join(self.fakes, name), os.O_WRONLY | os.O_CREAT, 0o755), "w", encoding="utf-8") as file:
                file.write(text)
        os.environ.update(PATH=f"{self.fakes}:/usr/bin:/bin", FAKES=self.fakes)
        os.chdir(folder)

    def fake(self, name, text=None):
        path = os.path.join(self.fakes, name)
        if text is None and os.path.exists(path):
            os.unlink(path)
        if text is not None:
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)

    def calls(self):
        """Of the programs since this was last asked."""
        path = os.path.join(self.fakes, "calls")
        if not os.path.exists(path):
            return []
        with open(path, encoding="utf-8") as file:
            found = [line.rstrip("\n").split("\t") for line in file]
        os.unlink(path)
        return found

    def batch(self, *words, shards=4, job=100):
        """A batch whose jobs are 101, the array, and 102, the merge."""
        self.batches += 1
        out = f"out{self.batches}"
        for name in ("squeue.says", "squeue.fails", "sacct.says", "sbatch.says", "sbatch.fails", "scancel.fails"):
            self.fake(name)
        self.fake("sacct.fails", "Slurm accounting storage is disabled\n")
        self.fake("job", f"{job}\n")
        glint("batch", "sweep", "a.exr", "-o", out, "--vary=screen_trace.steps=1..4", "--slurm", f"--shards={shards}", *words)
        return out

    def shard(self, out, number, of, results, total, kept=0, started=1000.0, written=1010.0, done=False, cut=False, **more):
        """What a shard leaves behind (journal/shard.h)."""
        folder = os.path.join(out, f"shards/{number}-of-{of}")
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, "shard.json"), "w", encoding="utf-8") as file:
            json.dump({"format": 1, "command": "sweep", "shard": number, "of": of, "results": total, "kept": kept, "done": done, **more}, file)
        with open(os.path.join(folder, "log.jsonl"), "w", encoding="utf-8") as file:
            file.write('{"capture":0,"point":0}\n' * results + '{"capture"' * cut)
        os.utime(os.path.join(folder, "shard.json"), (started, started))
        os.utime(os.path.join(folder, "log.jsonl"), (written, written))

    def status(self, out):
        return json.loads(glint("batch", "status", out, "--json").stdout)

    # ---- Scripts ----

    def test_job_scripts_call_the_command_with_the_same_words(self):
        hard = ["two words", "it's", 'a "quote"', "line\nbreak", "$HOME `id` $(id) \\ * ?", "\u202eabc\x1b[0m", "ünï", "--first", "-o"]
        os.makedirs("a 'folder'\n", exist_ok=True)
        glint("batch", "sweep", "--slurm", "--no-submit", "--shards", "5", "-o", "../out put", "--vary", "a=b c", "--repeat=0", "-p", "$HOME", "--no-pictures", "--set=x=",
              "-j", "--", *hard, folder="a 'folder'\n")
        scripts = {}
        for name in ("shard", "merge"):
            with open(f"out put/{name}.sbatch", encoding="utf-8") as file:
                scripts[name] = file.read()
            assert scripts[name].count(GLINT) == 1, scripts[name]
            with open(f"{name}.sh", "w", encoding="utf-8") as file:
                file.write(scripts[name].replace(GLINT, os.path.join(self.fakes, "words")))
            assert scripts[name].isprintable() or set(c for c in scripts[name] if not c.isprintable()) == {"\n"}, scripts[name]
        own = os.path.join(os.getcwd(), "a 'folder'\n")
        assert self.words("shard.sh", SLURM_ARRAY_TASK_ID="3") == [
            own, "sweep", "--shard=3/5", "--output=../out put", "--vary=a=b c", "--repeat=0", "--preset=$HOME", "--no-pictures", "--set=x=", "--", *hard]
        assert self.words("merge.sh") == [own, "merge", "../out put"]
        assert not self.calls()

    def test_every_command_with_shards_has_scripts(self):
        for k, (words, expected) in enumerate(((["lint", "a.exr"], ["lint", "--shard=2/3", "--output=X", "a.exr"]), (["validate", "s/", "a"], ["validate", "--shard=2/3", "--output=X", "s/", "a"]),
                                               (["compare", "s", "--presets", "a,b"], ["compare", "--shard=2/3", "--output=X", "--presets=a,b", "s"]),
                                               (["blame", "s", "--repeat", "0"], ["blame", "--shard=2/3", "--output=X", "--repeat=0", "s"]),
                                               (["check", "r", "--baseline=b", "-fail", "0.1"], ["check", "--shard=2/3", "--output=X", "--baseline=b", "--fail=0.1", "r"]))):
            out = f"every{k}"
            glint("batch", *words, "-o", out, "--slurm", "--no-submit", "--shards=3")
            with open(f"{out}/shard.sbatch", encoding="utf-8") as file, open("every.sh", "w", encoding="utf-8") as script:
                script.write(file.read().replace(GLINT, os.path.join(self.fakes, "words")))
            assert self.words("every.sh", SLURM_ARRAY_TASK_ID="2")[1:] == [word.replace("X", out) for word in expected]
            assert "no " in glint("batch", words[0], "-o", "none", "--slurm", status=2).stderr

    def test_of_tune_the_preset_is_the_output_and_its_folder_the_batch_s(self):
        for more, folder in (((), "half.tune"), (("--folder", "in here"), "in here")):
            glint("batch", "tune", "s", "-o", "half.json", "--budget-fetches=50%", *more, "--slurm", "--no-submit", "--shards=3")
            for name in ("shard", "merge"):
                with open(f"{folder}/{name}.sbatch", encoding="utf-8") as file, open(f"{name}.sh", "w", encoding="utf-8") as script:
                    script.write(file.read().replace(GLINT, os.path.join(self.fakes, "words")))
            words = self.words("shard.sh", SLURM_ARRAY_TASK_ID="2")[1:]
            assert words[:3] == ["tune", "--shard=2/3", f"--folder={folder}"] and words[-2:] == ["--output=half.json", "s"] and "--budget-fetches=50%" in words, words
            assert self.words("merge.sh")[1:] == ["merge", folder]
        assert "expected NAME.json" in glint("batch", "tune", "s", "-o", "half", "--slurm", status=2).stderr
        assert "-o NAME.json" in glint("batch", "tune", "s", "--slurm", status=2).stderr

    def words(self, script, **environment):
        subprocess.run(["bash", script], check=True, env={**os.environ, **environment})
        with open(os.path.join(self.fakes, "given"), encoding="utf-8") as file:
            return file.read().split("\0")[:-1]

    def test_options_of_sbatch_are_lines_of_both_scripts(self):
        out = self.batch("--gpus-per-task=2", "--partition=fast", "--sbatch=--time=1:00:00", '--sbatch=--comment=say "a\\b" #1', "--sbatch=--wckey=a#b", shards=7)
        for name, own in (("shard", "--array=1-7\n#SBATCH --output=logs/shard-%a-%A.txt"), ("merge", "--output=logs/merge-%j.txt")):
            with open(f"{out}/{name}.sbatch", encoding="utf-8") as file:
                text = file.read()
            expected = "\n#SBATCH ".join([own, "--ntasks=1", "--gpus-per-task=2", "--partition=fast", "--time=1:00:00", '--comment="say \\"a\\\\b\\" #1"', '--wckey="a#b"\n'])
            assert text.startswith("#!/bin/bash\n") and f"\n#SBATCH {expected}\ncd " in text, text
        for bad, said in (("--sbatch=time", "expected an option"), ("--sbatch=--comment=a\nb", "no line breaks"), ("--partition=a\nb", "no line breaks"),
                          ("--shard=1/2", "from its script"), ("--shards=0", "from 1 to"), ("-", "stdin"), ("--gpus-per-task=-1", "from 1 to")):
            assert said in glint("batch", "sweep", "a.exr", "-o", "none", "--slurm", bad, status=2).stderr
        assert "--slurm" in glint("batch", "sweep", "a.exr", "-o", "none", status=2).stderr
        assert "no output folder" in glint("batch", "sweep", "a.exr", "--slurm", status=2).stderr
        assert not os.path.exists("none")
        os.makedirs("100%", exist_ok=True)
        os.symlink("100%", "link")
        for name, folder in (("none 50%", "."), ("none\\b", "."), ("none", "100%"), ("link", ".")):
            assert "in its path" in glint("batch", "sweep", "../a.exr", "-o", name, "--slurm", folder=folder, status=2).stderr
            assert folder == "." and name == "link" or not os.path.exists(os.path.join(folder, name))

    # ---- Submitting ----

    def test_an_array_is_submitted_and_a_merge_that_waits_for_it(self):
        out = self.batch(shards=5)
        here = os.path.join(os.getcwd(), out)
        assert self.calls() == [["sbatch", here, "--parsable", "--kill-on-invalid-dep=yes", "--array=1-5", "shard.sbatch"],
                                ["sbatch", here, "--parsable", "--kill-on-invalid-dep=yes", "--dependency=afterok:101", "merge.sbatch"]]
        with open(f"{out}/batch.json", encoding="utf-8") as file:
            record = json.load(file)
        assert record["jobs"] == [{"job": "101", "shards": [1, 2, 3, 4, 5]}, {"job": "102", "merge": True}] and record["shards"] == 5, record
        assert os.path.isdir(f"{out}/logs"), "where Slurm writes what the jobs print"
        assert "resubmit" in glint("batch", "sweep", "a.exr", "-o", out, "--slurm", status=2).stderr and not self.calls()

    def test_what_is_printed_says_what_to_type_next(self):
        self.fake("job", "6\n")
        said = glint("batch", "sweep", "a.exr", "-o", "my steps", "--slurm", "--shards=2").stdout
        assert "shards 1-2 of 2 as job 7" in said and "merge as job 8" in said and "glint batch status 'my steps'" in said, said

    def test_what_sbatch_says_of_an_error_is_shown(self):
        self.fake("job", "6\n")
        self.fake("sbatch.fails", "sbatch: error: Batch job submission failed:\nInvalid partition name specified\n")
        said = glint("batch", "sweep", "a.exr", "-o", "refused", "--slurm", "--shards=2", status=1).stderr
        assert "submission failed: Invalid partition name" in said, said
        assert self.status("refused")["shards"][1]["state"] == "not begun"
        glint("batch", "sweep", "a.exr", "-o", "refused", "--slurm", "--shards=3", status=1)  # nothing was submitted, so that the same folder can be tried again
        self.fake("sbatch.fails")
        os.environ["PATH"] = "/usr/bin:/bin"
        try:
            if subprocess.run(["which", "sbatch"], capture_output=True).returncode:  # not on a machine with Slurm
                assert "sbatch: there is no such program" in glint("batch", "resubmit", "refused", status=1).stderr
        finally:
            os.environ["PATH"] = f"{self.fakes}:/usr/bin:/bin"
        glint("batch", "resubmit", "refused")
        assert self.calls()[-2][-2:] == ["--array=1-3", "shard.sbatch"]
        self.fake("sbatch.says", "no number\n")
        assert "number of a job" in glint("batch", "sweep", "a.exr", "-o", "odd", "--slurm", status=1).stderr

    def test_a_merge_that_could_not_be_submitted_leaves_the_array_known(self):
        self.fake("job", "20\n")
        with open(os.path.join(self.fakes, "sbatch"), "r+", encoding="utf-8") as file:
            whole = file.read()
            file.write('case "$*" in *merge*) exit 1;; esac\n')
        glint("batch", "sweep", "a.exr", "-o", "half", "--slurm", "--shards=2", status=1)
        with open(os.path.join(self.fakes, "sbatch"), "w", encoding="utf-8") as file:
            file.write(whole)
        self.calls()
        self.fake("squeue.says", "21|1|RUNNING|None\n21|2|PENDING|Resources\n")
        glint("batch", "resubmit", "half")
        assert self.calls()[-1][-2:] == ["--dependency=afterok:21_1:21_2", "merge.sbatch"]

    # ---- Status ----

    def test_status_has_slurm_s_states_and_the_journals_progress(self):
        out = self.batch()
        self.calls()
        self.shard(out, 1, 4, results=40, total=100, kept=20, written=1010)
        self.shard(out, 2, 4, results=90, total=100, done=True)
        self.shard(out, 3, 4, results=30, total=100, cut=True)
        self.fake("squeue.says", "101|1|RUNNING|None\n101|2|COMPLETED|None\n101|3|NODE_FAIL|NodeDown\n101|4|PENDING|Resources\n102|N/A|PENDING|Dependency\n99|1|FAILED|None\n")
        found = self.status(out)
        assert self.calls() == [["squeue", os.getcwd(), "--noheader", "--array", "--states=all", "--format=%F|%K|%T|%r", "--jobs=101,102"]]
        rows = [[s[k] for k in ("shard", "state", "reason", "job", "done", "results", "of", "per_second", "seconds_left")] for s in found["shards"]]
        assert rows == [[1, "running", None, "101_1", False, 40, 100, 2.0, 30.0], [2, "completed", None, "101_2", True, 90, 100, None, 0.0],
                        [3, "node fail", "NodeDown", "101_3", False, 30, 100, 3.0, 23.3333333], [4, "pending", "Resources", "101_4", False, 0, None, None, None]], rows
        assert found["missing"] == [3] and found["shards_done"] == 1 and found["results"] == 160, found
        assert found["merge"] == {"job": "102", "state": "pending", "reason": "Dependency", "done": False}, found
        text = glint("batch", "status", out).stdout
        assert [line.split() for line in text.splitlines()[1:4]] == [
            ["1", "running", "101_1", "40", "100", "2", "30", "s"], ["2", "completed", "101_2", "90", "100"],
            ["3", "node", "fail", "(NodeDown)", "101_3", "30", "100", "3", "23", "s"]], text
        assert f"glint batch resubmit {out}" in text and "job 102, is pending" in text, text

    def test_status_says_why_shards_failed(self):
        out = self.batch(shards=6)
        for name, text in (("1-101", "fine\n"), ("2-100", "an older one\n"), ("2-101", "shard 2\nglint sweep: a.exr: \x1b[0m\n\n"), ("3-101", ""), ("4-101", "x" * 1000), ("5-101", "5"),
                           ("6-101", "not shown")):
            with open(f"{out}/logs/shard-{name}.txt", "w", encoding="utf-8") as file:
                file.write(text)
        self.shard(out, 1, 6, results=2, total=2, done=True)
        self.fake("squeue.says", "".join(f"101|{i}|FAILED|NonZeroExitCode\n" for i in range(2, 7)))
        said = glint("batch", "status", out).stdout.splitlines()
        at = said.index("2: glint sweep: a.exr: \\x1b[0m")
        assert said[at + 1] == f"4: {'x' * 255}" and said[at + 2] == "5: 5" and said[at + 3].startswith("2-6: not done"), said
        os.unlink(f"{out}/logs/shard-2-101.txt")
        os.symlink("shard-2-100.txt", f"{out}/logs/shard-2-101.txt")
        assert "older" not in glint("batch", "status", out).stdout

    def test_jobs_that_have_left_the_queue_are_known_to_the_accounts(self):
        out = self.batch()
        self.fake("squeue.fails", "slurm_load_jobs error: Invalid job id specified\n")
        found = self.status(out)
        assert found["missing"] == [1, 2, 3, 4] and found["slurm"], "Slurm has answered that it has no such jobs"
        self.fake("sacct.fails")
        self.fake("sacct.says", "101_1|TIMEOUT\n101_[3-4]|PENDING\n101_2|CANCELLED by 1000\n102|COMPLETED\n")
        found = self.status(out)
        assert [s["state"] for s in found["shards"]] == ["timeout", "cancelled", "not begun", "not begun"] and found["merge"]["state"] == "completed", found

    def test_status_does_without_slurm(self):
        out = self.batch()
        self.shard(out, 1, 4, results=3, total=3, done=True)
        self.shard(out, 3, 4, results=1, total=3)
        self.fake("squeue.fails", "slurm_load_jobs error: Unable to contact slurm controller (connect failure)\n")
        said = glint("batch", "status", out)
        assert "from the journals alone" in said.stderr and "Unable to contact" in said.stderr, said.stderr
        assert [line.split()[1] for line in said.stdout.splitlines()[1:5]] == ["done", "not", "begun", "not"], said.stdout
        found = self.status(out)
        assert not found["slurm"] and found["missing"] == [], found
        self.fake("squeue.fails")
        self.calls()
        self.shard("parallel", 2, 3, results=4, total=5)
        found = self.status("parallel")
        assert [s["results"] for s in found["shards"]] == [0, 4, 0] and found["command"] == "sweep" and not self.calls(), found
        self.shard("parallel", 1, 2, results=4, total=5)
        assert "shards of " in glint("batch", "status", "parallel", status=1).stderr
        assert "shards/K-of-N" in glint("batch", "status", "nowhere", status=2).stderr and not os.path.exists("nowhere")

    # ---- Going on ----

    def test_resubmit_submits_what_is_neither_done_nor_in_the_queue(self):
        out = self.batch(shards=8)
        self.calls()
        for number in (1, 6):
            self.shard(out, number, 8, results=2, total=3, done=True)
        self.shard(out, 2, 8, results=2, total=3)
        self.fake("squeue.says", "101|1|COMPLETED|None\n101|2|FAILED|NonZeroExitCode\n101|5|RUNNING|None\n101|6|FAILED|None\n101|7|COMPLETING|None\n102|N/A|PENDING|Dependency\n")
        said = glint("batch", "resubmit", out).stdout
        here = os.path.join(os.getcwd(), out)
        assert self.calls()[-3:] == [["scancel", here, "102"], ["sbatch", here, "--parsable", "--kill-on-invalid-dep=yes", "--array=2-4,8", "shard.sbatch"],
                                     ["sbatch", here, "--parsable", "--kill-on-invalid-dep=yes", "--dependency=afterok:103:101_5:101_7", "merge.sbatch"]]
        assert "shards 2-4,8 of 8 as job 103" in said, said
        self.fake("squeue.says", "101|5|RUNNING|None\n101|7|RUNNING|None\n101|2|FAILED|None\n103|2|RUNNING|None\n103|3|RUNNING|None\n103|4|PENDING|None\n103|8|PENDING|None\n"
                                 "104|N/A|PENDING|Dependency\n")
        assert "nothing is missing" in glint("batch", "resubmit", out).stdout
        assert [call[0] for call in self.calls()] == ["squeue", "sacct"], "1 and 6 are known to neither"
        assert [s["job"] for s in self.status(out)["shards"]] == [f"{job}_{i}" for i, job in enumerate((101, 103, 103, 103, 101, 101, 101, 103), 1)]

    def test_resubmit_merges_what_is_done(self):
        out = self.batch(shards=2)
        for number in (1, 2):
            self.shard(out, number, 2, results=2, total=3, done=True)
        self.fake("squeue.says", "101|1|COMPLETED|None\n101|2|COMPLETED|None\n102|N/A|FAILED|NonZeroExitCode\n")
        assert "glint merge" in glint("batch", "status", out).stdout or "merge, job 102, is failed" in glint("batch", "status", out).stdout
        self.calls()
        assert "the merge as job 103" in glint("batch", "resubmit", out).stdout
        assert self.calls()[-1][2:] == ["--parsable", "--kill-on-invalid-dep=yes", "merge.sbatch"]
        with open(f"{out}/index.html", "w", encoding="utf-8"):
            pass
        assert "merged" in glint("batch", "resubmit", out).stdout and self.calls()[-1][0] != "sbatch"
        assert "merged: " in glint("batch", "status", out).stdout and self.status(out)["merge"]["done"]
        os.utime(f"{out}/index.html", (999, 999))
        assert not self.status(out)["merge"]["done"], "it is of an earlier sweep"
        os.utime(f"{out}/index.html", (2000, 2000))
        assert self.status(out)["merge"]["done"]
        self.shard(out, 1, 2, results=2, total=3, done=True, result="results.json")
        self.shard(out, 2, 2, results=2, total=3, done=True, result="results.json")
        assert not self.status(out)["merge"]["done"], "the command has another result"
        with open(f"{out}/results.json", "w", encoding="utf-8"):
            pass
        assert self.status(out)["merge"]["done"]
        self.shard(out, 2, 2, results=2, total=3)
        assert not self.status(out)["merge"]["done"], "it is of an earlier sweep"

    def test_resubmit_stops_where_slurm_does_not_answer(self):
        out = self.batch()
        self.calls()
        self.fake("squeue.fails", "slurm_load_jobs error: Unable to contact slurm controller\n")
        assert "Unable to contact" in glint("batch", "resubmit", out, status=1).stderr
        assert [call[0] for call in self.calls()] == ["squeue"], "what may still run is not submitted again"
        assert "no batch.json" in glint("batch", "resubmit", self.folder, status=2).stderr

    def test_cancel_takes_out_what_is_in_the_queue(self):
        out = self.batch(shards=3)
        self.shard(out, 1, 3, results=2, total=2, done=True)
        self.fake("squeue.says", "101|1|COMPLETED|None\n101|2|FAILED|None\n101|3|RUNNING|None\n102|N/A|PENDING|Dependency\n")
        found = json.loads(glint("batch", "resubmit", out, "--json").stdout)
        assert [(s["job"], s["state"]) for s in found["shards"]] == [("101_1", "completed"), ("103_2", "not begun"), ("101_3", "running")] and found["merge"]["job"] == "104", found
        self.fake("squeue.says", "101|1|COMPLETED|None\n101|3|RUNNING|None\n103|2|PENDING|None\n104|N/A|PENDING|Dependency\n")
        self.calls()
        assert "101" in glint("batch", "cancel", out).stdout
        assert [call for call in self.calls() if call[0] == "scancel"] == [["scancel", os.path.join(os.getcwd(), out), "104", "103", "101"]]
        self.fake("squeue.says", "101|3|CANCELLED|None\n103|2|CANCELLED|None\n104|N/A|CANCELLED|None\n")
        assert "nothing" in glint("batch", "cancel", out).stdout and self.calls()[-1][0] != "scancel"

    def test_a_folder_of_somebody_else_is_read_with_care(self):
        out = self.batch(shards=2)
        self.calls()
        for jobs, said in (([{"job": "-x", "merge": True}], "job 1"), ([{"job": "1", "shards": [3]}], "job 1"), ([{"job": "1"}], "job 1"), ([7], "job 1"), (7, '"jobs"')):
            with open(f"{out}/batch.json", "w", encoding="utf-8") as file:
                json.dump({"format": 1, "command": "sweep", "shards": 2, "jobs": jobs}, file)
            assert said in glint("batch", "cancel", out, status=1).stderr
        for record in ({"format": 2}, {"format": 1, "command": "x" * 100}, {"format": 1, "command": "sweep", "shards": 10**9}, []):
            with open(f"{out}/batch.json", "w", encoding="utf-8") as file:
                json.dump(record, file)
            assert "batch.json: expected" in glint("batch", "status", out, status=1).stderr
        os.unlink(f"{out}/batch.json")
        self.shard(out, 1, 2, results=1, total=-5)
        assert "shard.json: expected" in glint("batch", "status", out, status=1).stderr
        self.shard(out, 1, 2, results=1, total=5)
        os.unlink(f"{out}/shards/1-of-2/log.jsonl")
        os.mkfifo(f"{out}/shards/1-of-2/log.jsonl")
        assert "found a device or a pipe" in glint("batch", "status", out, status=1).stderr
        assert not self.calls()

    def test_wrong_words_are_usage_errors(self):
        for words, said in ((["statu", "x"], "found statu"), ([], "expected a command with --shard ("), (["status"], "one folder"), (["cancel", "a", "b"], "one folder"),
                            (["resubmit", "a", "--shards=2"], "no option but --json"), (["status", "a", "--sbatch=-x"], "no option but --json"),
                            (["sweep", "a.exr", "-o", "x", "--slurm", "--varry=x"], "did you mean --vary")):
            assert said in glint("batch", *words, status=2).stderr, words

    def test_help_has_the_options_of_the_command_too(self):
        assert "--vary=NAMES" in glint("batch", "sweep", "--help").stdout and "--vary=NAMES" not in glint("batch", "--help").stdout
        assert "--vary=" in glint("--complete", "batch", "sweep", "--va").stdout and not glint("--complete", "batch", "status", "--va").stdout
        assert glint("--complete", "batch", "re").stdout.startswith("resubmit")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        sys.exit(tap.run(Tests(scratch)))
