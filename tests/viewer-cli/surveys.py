"""lint, validate, check and compare over many captures: in shards and with -o they say what one process says, and go on where they stopped.
surveys.py GLINT [all]. Speaks TAP. `all` compares several effects, and merges long journals."""
import csv
import json
import os
import re
import shutil
import sys
import tempfile

import tap
from timeless import contents

ALL = sys.argv[2:] == ["all"]
LINT, VALIDATE, CHECK = ["lint", "set"], ["validate", "set"], ["check", "runs", "--baseline", "bases"]
COMPARE = ["compare", "set", "--presets", tap.PLAIN, "--effect", "reflection", "--repeat", "1"]
SMALL = ["--size", "16x9", "--cube-size", "4", "--light", "1"]
MARK = {"id": "depth.reversed", "likelihood": "possible"}  # no capture here has this finding


def without_numbers(value):
    """Numbers of a page may be times; what of them is there stays."""
    if isinstance(value, dict):
        return {k: without_numbers(v) for k, v in value.items()}
    if isinstance(value, list):
        return [without_numbers(v) for v in value]
    return "number" if isinstance(value, float) else value


class Tests:
    def __init__(self, folder):
        self.folder = folder
        os.chdir(folder)
        os.mkdir("set")
        for scene in ("room", "still_life"):
            tap.glint("sample", scene, "-o", f"set/{scene}.exr", *SMALL, "--truth", "1")
        tap.glint("set", "set/room.exr", "-o", "set/wrong.exr", "normalSpace=view")
        with open("set/unreadable.exr", "wb") as file:
            file.write(b"not an image")
        for name, more in (("run", ()), ("other", ("--set", "screen_trace.length_m=0"))):
            tap.glint("replay", "set/room.exr", "-p", tap.PLAIN, "--outputs", "reflection", "-o", name, *more)
        for name, run, base in (("same", "run", "run"), ("changed", "other", "run"), ("broken", "run", "run"), ("new", "run", None)):
            shutil.copytree(run, f"runs/{name}")
            if base:
                shutil.copytree(base, f"bases/{name}")
        for name in os.listdir("runs/broken"):
            if name.endswith(".exr"):
                os.truncate(f"runs/broken/{name}", 100)

    def cut(self, words, out, count):
        """Does all shares; the keys of the lines of each."""
        found = []
        for number in range(1, count + 1):
            said = tap.glint(*words, "-o", out, "--shard", f"{number}/{count}").stdout
            with open(f"{out}/shards/{number}-of-{count}/log.jsonl", encoding="utf-8") as file:
                found.append([line.get("capture", line.get("run")) for line in map(json.loads, file)])
            assert f"shard {number} of {count}: {len(found[-1])} of 4 " in said, said
        assert sorted(sum(found, [])) == [0, 1, 2, 3] and min(map(len, found)) >= 1, found

    def check_survey(self, words, status, like_before=True):
        """Without a folder, with one, in shards: the same text, messages, JSON, files and status."""
        name = words[0]
        plain, written = tap.glint(*words, "--json", status=status), tap.glint(*words, "-o", f"{name}-one", status=status)
        assert os.listdir(f"{name}-one") == ["results.json"], "its journal is removed"
        with open(f"{name}-one/results.json", encoding="utf-8") as file:
            assert file.read() == plain.stdout
        if like_before:
            assert tap.glint(*words, status=status).stdout == written.stdout
        self.cut(words, f"{name}-cut", 3)
        merged = tap.glint("merge", f"{name}-cut", status=status)
        assert (merged.stdout, merged.stderr) == (written.stdout, written.stderr)
        assert contents(f"{name}-cut", "shards") == contents(f"{name}-one")
        assert json.loads(tap.glint("batch", "status", f"{name}-cut", "--json").stdout)["merge"]["done"]
        again = tap.glint("merge", f"{name}-cut", "--json", status=status)
        assert (again.stdout, again.stderr) == (plain.stdout, plain.stderr)
        return written

    def test_lint(self):
        assert "normal.world_space" in self.check_survey(LINT, 1).stdout

    def test_validate(self):
        said = self.check_survey(VALIDATE, 1)
        assert "4 captures: 3 valid, 1 invalid, 0 unreadable" in said.stdout
        assert "nowhere.exr" in tap.glint("validate", "nowhere.exr", "-o", "nowhere", status=1).stderr

    def test_check(self):
        said = self.check_survey(CHECK, 4, like_before=False)
        rows = [line.split() for line in said.stdout.splitlines() if line.startswith("runs/")]
        assert [row[:2] for row in rows] == [["runs/broken", "unreadable"], ["runs/changed", "fails"], ["runs/new", "fails"], ["runs/same", "same"]], said.stdout
        assert tap.glint(*CHECK, status=4).stdout.endswith(said.stdout), "which is the table alone"

    def compared(self, words, whole, cut):
        """Compares in one process and in shards."""
        one = tap.glint(*words, "-o", whole, status=1)
        for number in (1, 2):
            tap.glint(*words, "-o", cut, "--shard", f"{number}/2")
        merged = tap.glint("merge", cut, status=1)
        found = [contents(whole), contents(cut, "shards")]
        assert found[0].keys() == found[1].keys() and not any("log.jsonl" in name for name in found[0]), found[0].keys() ^ found[1].keys()
        for name in found[0]:
            for files in found:
                if name.endswith("page.json"):
                    files[name] = without_numbers(files[name])
                if name.endswith(".csv"):
                    files[name] = [{k: v for k, v in row.items() if not k.endswith(" ms")} for row in csv.DictReader(files[name].decode().splitlines())]
            assert name.endswith("index.html") or found[0][name] == found[1][name], name
        texts = [re.sub(r"[\d.]+", "number", run.stdout) for run in (one, merged)]
        assert sorted(texts[0].split()) == sorted(texts[1].split()), texts
        return found[0]

    def test_compare(self):
        files = self.compared(COMPARE, "compare-one", "compare-cut")
        assert len(files["table.json"]["captures"]) == 4 and len([name for name in files if name.startswith("pictures/")]) >= 6, files.keys()
        logs = []
        for number in (1, 2):
            with open(f"compare-cut/shards/{number}-of-2/log.jsonl", encoding="utf-8") as file:
                logs.append([json.loads(line)["capture"] for line in file])
        assert sum(logs, []) == [0, 1, 2, 3] and min(map(len, logs)) == 2

    # ---- Shares ----

    def shares(self, words, out):
        """What the two shares do."""
        for number in (1, 2):
            tap.glint(*words, "-o", out, "--shard", f"{number}/2")
        logs = []
        for number in (1, 2):
            with open(f"{out}/shards/{number}-of-2/log.jsonl", encoding="utf-8") as file:
                logs.append([line.get("capture", line.get("run")) for line in map(json.loads, file)])
        return logs

    def write_garbage(self, folder, **sizes):
        os.makedirs(folder, exist_ok=True)
        for name, size in sizes.items():
            with open(f"{folder}/{name}.exr", "wb") as file:
                file.write(b"x" * size)

    def test_shares_are_cut_by_the_bytes_of_files(self):
        self.write_garbage("bytes", a=3000, b=1000, c=1000, d=1000)
        assert self.shares(["validate", "bytes"], "bytes-cut") == [[0], [1, 2, 3]]
        with open("runs/broken/more", "wb") as file:  # which no image is in
            file.write(b"x" * 1000000)
        assert self.shares(CHECK, "bytes-check") == [[0], [1, 2, 3]]
        os.remove("runs/broken/more")

    def test_shares_of_compare_are_cut_by_pixels(self):
        self.write_garbage("pixels", b=500000, c=500000, d=500000)
        shutil.copy("set/room.exr", "pixels/a.exr")
        shutil.copy(tap.PLAIN, "short.json")
        presets = f"{tap.PLAIN},short.json"
        assert self.shares(["compare", "pixels", "--presets", presets, *COMPARE[4:]], "pixels-cut") == [[0], [1, 2, 3]]
        with open("pixels-cut/shards/1-of-2/shard.json", encoding="utf-8") as file:
            assert presets in json.load(file)["arguments"], "as they were typed"

    # ---- Going on ----

    def interrupted(self, words, out, change=lambda lines: lines):
        """A folder as a killed process leaves it, with so many of the lines: those of the only share, which is the whole survey."""
        only = f"only-{words[0]}/shards/1-of-1"
        if not os.path.exists(only):
            tap.glint(*words, "-o", f"only-{words[0]}", "--shard", "1/1")
        os.mkdir(out)
        shutil.copy(f"{only}/{words[0]}.json", out)
        with open(f"{only}/log.jsonl", encoding="utf-8") as file:
            lines = change([json.loads(line) for line in file])
        with open(f"{out}/log.jsonl", "w", encoding="utf-8") as file:
            file.write("".join(json.dumps(line) + "\n" for line in lines) + '{"capture": 1, "fin')

    def test_what_a_journal_has_is_not_done_again(self):
        self.interrupted(LINT, "resumed", lambda lines: [{**lines[0], "findings": [MARK]}])
        found = json.loads(tap.glint(*LINT, "-o", "resumed", "--json", status=1).stdout)
        assert [row["capture"] for row in found["captures"] if row.get("findings") == [MARK]] == ["set/room.exr"]
        assert found["summary"] == {"captures": 4, "with_findings": 2, "unreadable": 1}, found["summary"]
        assert os.listdir("resumed") == ["results.json"], os.listdir("resumed")
        self.interrupted(VALIDATE, "validated", lambda lines: [{"capture": 0, "error": "from the journal"}])
        found = json.loads(tap.glint(*VALIDATE, "-o", "validated", "--json", status=1).stdout)
        assert [file.get("error") for file in found["files"]] == ["from the journal", None, None, None]
        self.interrupted(CHECK, "checked", lambda lines: [{"run": 3, "result": {"a": "", "b": "", "status": 3}}])
        found = json.loads(tap.glint(*CHECK, "-o", "checked", "--json", status=4).stdout)
        assert [run["status"] for run in found["runs"]] == [4, 2, 2, 3]

    def test_a_journal_of_other_captures_is_refused(self):
        self.interrupted(VALIDATE, "other-captures")
        before = os.stat("set/room.exr").st_mtime_ns
        os.utime("set/room.exr", (1, 1))
        assert "contains a validate with other captures" in tap.glint(*VALIDATE, "-o", "other-captures", status=2).stderr
        os.utime("set/room.exr", ns=(before, before))
        self.interrupted(CHECK, "other-limits")
        assert "contains a check with other fail" in tap.glint(*CHECK, "-fail", "0.5", "-o", "other-limits", status=5).stderr
        assert "log.jsonl" in os.listdir("other-limits")

    def test_lines_of_strangers_are_refused(self):
        many, long = [MARK] * 33, {"id": "x" * 48, "likelihood": "certain"}
        for k, (words, line, said) in enumerate((
                (LINT, {"capture": 4}, "expected a line"), (LINT, {"run": 0}, "expected a line"), (LINT, {"capture": 0}, "not one of this lint"),
                (LINT, {"capture": 0, "findings": many}, "not one of this lint"), (LINT, {"capture": 0, "findings": [long]}, "not one of this lint"),
                (LINT, {"capture": 0, "findings": [{"id": "a", "likelihood": "sure"}]}, "not one of this lint"),
                (VALIDATE, {"capture": 0, "violations": 7}, "not one of this validate"), (CHECK, {"run": 0, "result": {"status": 9}}, "not one of this check"))):
            self.interrupted(words, f"strange{k}", lambda lines: [line])
            status = 4 if words is CHECK else 1
            assert said in tap.glint(*words, "-o", f"strange{k}", status=status).stderr
            assert "log.jsonl" in os.listdir(f"strange{k}"), "what cannot be read is not removed"
        self.interrupted(VALIDATE, "endless")
        os.truncate("endless/log.jsonl", 70 << 20)  # a line of zeros without an end
        assert "lines of at most 64 MiB" in tap.glint(*VALIDATE, "-o", "endless", status=1).stderr

    def test_folders_that_cannot_be_written(self):
        for words, said, status in (([*LINT, "--shard", "1/2"], "-o FOLDER", 2), (["lint", "set/room.exr", "-o", "copy.exr"], "expected a folder", 2),
                                    (["lint", "set/room.exr", "--fix"], "-o F2", 2), ([*CHECK, "-o", "heat.png"], "one run only", 5),
                                    ([*CHECK, "--approve", "-o", "kept"], "--approve", 5), (["validate", "-", "-o", "kept", "--shard", "1/2"], "stdin", 2),
                                    (["check", "run", "--baseline", "run", "-o", "heat.png", "--shard", "1/2"], "folder of runs", 5)):
            assert said in tap.glint(*words, status=status).stderr, words
        assert not {"copy.exr", "heat.png"} & set(os.listdir())

    # ---- Merging ----

    def test_a_shard_may_have_several_studies(self):
        self.cut(VALIDATE, "several", 2)
        for number in (1, 2):
            folder = f"several/shards/{number}-of-2"
            for name in ("a", "b"):
                os.mkdir(f"{folder}/{name}")
                for file in ("validate.json", "log.jsonl"):
                    shutil.copy(f"{folder}/{file}", f"{folder}/{name}")
            os.remove(f"{folder}/validate.json")
        assert "8 results" in tap.glint("merge", "several", "--journal-only").stdout
        for name in ("a", "b"):
            with open(f"several/{name}/log.jsonl", encoding="utf-8") as file:
                assert [json.loads(line)["capture"] for line in file] == [0, 1, 2, 3]

    if ALL:
        def test_compare_of_several_effects(self):
            os.mkdir("effects")
            for scene in ("courtyard", "lake"):
                tap.glint("sample", scene, "-o", f"effects/{scene}.exr", *SMALL, "--truth", "1", "--truth-of", "reflection,occlusion")
            shutil.copy("set/unreadable.exr", "effects")
            files = self.compared(["compare", "effects", "--presets", f"mafia_de_frame,{tap.PLAIN}", "--repeat", "1"], "effects-one", "effects-cut")
            assert {"reflection/table.json", "occlusion/table.json"} <= files.keys()
            assert json.loads(tap.glint("batch", "status", "effects-cut", "--json").stdout)["merge"]["done"]

        def test_journals_of_any_size(self):
            self.cut(VALIDATE, "long", 2)
            for number in (1, 2):
                path = f"long/shards/{number}-of-2/log.jsonl"
                with open(path, encoding="utf-8") as file:
                    lines = file.readlines()
                with open(path, "w", encoding="utf-8") as file:
                    file.writelines("{" + " " * (60 << 20) + line[1:] for line in lines)
                    for i in range(5, 9):
                        file.write(f'{{"capture":{2 * i + number},{" " * (60 << 20)}"findings":[]}}\n')
            tap.glint("merge", "long", "--journal-only")
            assert os.path.getsize("long/log.jsonl") > 12 * (60 << 20)


def main():
    sys.argv[1] = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="glint-surveys-") as folder:
        return tap.run(Tests(folder))


sys.exit(main())
