#!/usr/bin/env python3
"""docs/mutants.md: whether the self-test and the device tests notice when passes/ is wrong.

mutants.py run BUILD -o RECORD [--jobs N] [--again survived|all]   tries each mutant; goes on where a record ends
mutants.py check BUILD -o RECORD                                   the same, all anew if anything changed, and speaks TAP (./dev test --all)
mutants.py page RECORD... -o PAGE                                  the page of those records

A mutant's file lies alone in a folder; programs take passes from there ($GLINT_PASSES). Each is tried by the programs that have the
file in what they run, quickest first, until one fails. A control run of unchanged sources on the same way, which must pass, tells
which those are: those that open the file."""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

import mutate
import mutants_page
from mutant_rows import AT_LEAST_S, SLOWER

ROOT = pathlib.Path(__file__).resolve().parent.parent
ENVIRONMENT = {"GLINT_CACHE": "none", "CMOCKA_MESSAGE_OUTPUT": "TAP", "GLINT_REQUIRE_DEVICE": "1", "GLINT_TEST_UNCHECKED": "1"}
HOST_TEST = "test_cubemap_active"


# ---- Programs ----

class Program:
    """What may notice: its name, and how to run it."""

    def __init__(self, name, command, selftest=False):
        self.name, self.command, self.selftest = name, [str(c) for c in command], selftest
        self.failing = []  # cases that do not count
        self.version = hashlib.sha256(pathlib.Path(self.command[0]).read_bytes() + name.encode()).hexdigest()[:8]

    def run(self, passes, timeout_s):
        """None when all passes, else what failed; and how many cases there were."""
        with tempfile.TemporaryDirectory(prefix="gm") as folder:
            environment = {**os.environ, **ENVIRONMENT, "GLINT_PASSES": str(passes), "TMPDIR": folder}
            process = subprocess.Popen(["stdbuf", "-oL", *self.command], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                       env=environment, start_new_session=True, errors="replace")
            late = threading.Timer(timeout_s, self.stop, [process])
            late.start()
            start = time.monotonic()
            try:
                failed, cases = (self.read_json if self.selftest else self.read_tap)(process)
            finally:
                over = time.monotonic() - start >= timeout_s
                late.cancel()
                self.stop(process)
                process.stdout.close()
                status = process.wait()
        return (f"no end in {timeout_s:.0f} s" if over else failed or (f"died of signal {-status}" if status < 0 and not failed else None)), cases

    @staticmethod
    def stop(process):
        try:
            os.killpg(process.pid, signal.SIGKILL) if process.poll() is None else None
        except ProcessLookupError:
            pass

    @staticmethod
    def read_tap(process):
        cases, planned = 0, None
        for line in process.stdout:
            if line.startswith("not ok"):
                return re.sub(r"^not ok \d+ - ", "", line).strip().replace("_", " "), cases
            if re.match(r"ok \d+", line) and "# SKIP" not in line:
                cases += 1
            planned = int(line[3:]) if re.fullmatch(r"1\.\.\d+\n", line) else planned
        process.wait()
        return (None if process.returncode == 0 and cases == planned else f"exit status {process.returncode}, {cases} of {planned} cases"), cases

    def read_json(self, process):
        text = process.stdout.read()
        process.wait()
        cases = json.loads(text)["cases"] if text.startswith("{") else []
        failed = [c["name"] for c in cases if not c["pass"] and c["name"] not in self.failing]
        if failed:
            return ", ".join(failed), len(cases)
        return (None if process.returncode in (0, 1) and cases else f"exit status {process.returncode}"), len(cases)


def programs_of(build):
    glint = build / "viewer-cli/glint"
    listed = json.loads(subprocess.run([glint, "selftest", "--list", "--json"], capture_output=True, text=True, check=True).stdout)["cases"]
    groups = {}
    for case in listed:
        groups.setdefault(case["group"], []).append(case["name"])
    for group, names in groups.items():
        only = [word for name in names for word in ("--only", name)]
        yield Program(f"selftest {group}", [glint, "selftest", "--json", "--quick", *only], True)
    for path in sorted(p for folder in ("passes", "replay") for p in (build / "tests" / folder).glob("gpu_*")):
        if path.is_file() and os.access(path, os.X_OK):
            yield Program(path.name, [path])


# ---- Control ----

def opened(folder):
    return [p.relative_to(folder).as_posix() for p in folder.rglob("*.*") if p.is_file() and p.stat().st_atime > 1]


def control_of(program, known):
    """How long unchanged sources take, and which of them are opened: told by the time of access, which a file system keeps when
    it lies before that of the last change."""
    if known.get(program.name, {}).get("version") == program.version:
        return known[program.name]
    with tempfile.TemporaryDirectory(prefix="gm") as folder:
        passes = pathlib.Path(folder) / "passes"
        shutil.copytree(ROOT / "passes", passes)
        for path in passes.rglob("*.*"):
            os.utime(path, (1, time.time()))
        start = time.monotonic()
        failed, cases = program.run(passes, 600)
        seconds = time.monotonic() - start
        files = opened(passes)
    failing = (failed.split(", ") if failed else []) if program.selftest and cases else [failed or "no cases"] if failed or not cases else []
    return {"version": program.version, "seconds": round(seconds, 2), "cases": cases, "failing": failing, "files": sorted(f for f in files if f.endswith((".glsl", ".comp")))}


def control(programs, known, jobs):
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        told = dict(zip([p.name for p in programs], pool.map(lambda p: control_of(p, known), programs)))
    if not any(t["files"] for t in told.values()):
        sys.exit("mutants: the file system does not tell which files were opened; set TMPDIR to one that does (relatime)")
    return told


# ---- Mutants ----

def key_of(source, mutant):
    """Tells a mutant in other versions of its file, too."""
    start, end = source.text.rfind("\n", 0, mutant.start) + 1, source.text.find("\n", mutant.end)
    before, after = source.text[start:end].strip(), (source.text[start:mutant.start] + mutant.new + source.text[mutant.end:end]).strip()
    return before, " ".join(after.split("\n")), source.text.count("\n", 0, mutant.start) + 1


def drawn(progress, known):
    def is_known(source, mutant):
        before, after, _ = key_of(source, mutant)
        return (mutant.file, mutant.operator, before, after) in known

    tree, chosen, inside, rejected, mechanisms = mutate.choose(ROOT / "passes", progress, is_known)
    rows = []
    for m in sorted(chosen, key=lambda m: (m.file, m.start)):
        before, after, line = key_of(tree.sources[m.file], m)
        rows.append({"file": m.file, "line": line, "operator": m.operator, "before": before, "after": after, "span": [m.start, m.end],
                     "new": m.new, "mechanisms": inside[m], "passes": tree.passes_with(m.file)})
    return {"seed": mutate.SEED, "sources": tree.digest(), "rejected": rejected, "mechanisms": mechanisms,
            "passes": sorted(p.rsplit(".", 1)[0] for p in tree.closures), "mutants": rows}


def write_mutant(row, folder):
    text = (ROOT / "passes" / row["file"]).read_text()
    path = pathlib.Path(folder) / row["file"]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text[:row["span"][0]] + row["new"] + text[row["span"][1]:])
    return path


def try_host(row, folder, build):
    """What runs on the host is linked into its test anew."""
    program = f"{folder}/{HOST_TEST}"
    archives = sorted(str(p) for p in (build / "passes").glob("*.a")) + sorted(str(p) for p in (build / "capture-format").glob("*.so"))
    subprocess.run(["cc", "-std=c11", "-D_POSIX_C_SOURCE=200809L", "-D_DEFAULT_SOURCE", "-g", "-I", ROOT / "passes/include", "-I",
                    ROOT / "capture-format/include", "-o", program, ROOT / f"tests/passes/{HOST_TEST}.c", write_mutant(row, folder), *archives,
                    f"-Wl,-rpath,{build / 'capture-format'}", "-lcmocka", "-lm"], check=True)
    return Program(HOST_TEST, [program]).run(folder, AT_LEAST_S)[0]


LOCK, OUTCOMES = threading.Lock(), collections.defaultdict(list)  # of programs, by the slot of what they were tried on


OUTCOME = ("verdict", "by", "failed", "seconds", "passed", "untried")


def slot_of(file):
    return file if file.startswith("shared/") else file.split("/")[0]


def likeliest(programs, file, told):
    """Those that have the file in what they run: first those that are there for it, by their names; then by the chance, as found so
    far, that a second of theirs notices."""
    def is_own(program):
        words = {"shared": "functions", "temporal": "time", "temporal_sharp": "time", "screen_trace": "geometry", "cubemap_trace": "geometry"}
        slot = file.split("/")[0]
        return slot in program.name or words.get(slot, slot) in program.name

    def chance(program):
        with LOCK:
            found = OUTCOMES[slot_of(file), program.name]
            return (sum(found) + 0.3) / (len(found) + 1) / told[program.name]["seconds"]

    return sorted((p for p in programs if file in told[p.name]["files"]), key=lambda p: (is_own(p), chance(p)), reverse=True)


def attempt(row, build, programs, told, budget_s=math.inf):
    """The row with what became of it. No program is begun once those before it take budget_s with unchanged sources."""
    start, passed = time.monotonic(), dict(row.get("passed", {}))
    with tempfile.TemporaryDirectory(prefix="gm") as folder:
        if row["file"].endswith(".c"):
            failed, by = try_host(row, folder, build), HOST_TEST
        else:
            write_mutant(row, folder)
            failed = by = None
            spent_s = 0
            for program in likeliest(programs, row["file"], told):
                if failed is None and passed.get(program.name) != program.version and spent_s < budget_s:
                    spent_s += told[program.name]["seconds"]
                    failed, _ = program.run(folder, max(AT_LEAST_S, SLOWER * told[program.name]["seconds"]))
                    by = program.name
                    passed.update({} if failed else {by: program.version})
                    with LOCK:
                        OUTCOMES[slot_of(row["file"]), by] += [failed is not None]
    made = {k: v for k, v in row.items() if k not in OUTCOME}
    return {**made, "verdict": "killed" if failed else "survived", **({"by": by, "failed": failed} if failed else {}),
            "seconds": round(row.get("seconds", 0) + time.monotonic() - start, 1),
            **({} if failed else {"passed": passed, "untried": [p.name for p in programs if row["file"] in told.get(p.name, {}).get("files", ()) and p.name not in passed]})}


class Bar:
    def __init__(self, what):
        self.what = what

    def __call__(self, done, count):
        if sys.stderr.isatty():
            print(f"\r{self.what} {done}/{count} {'#' * (40 * done // max(count, 1)):40}", end="\n" if done == count else "", file=sys.stderr, flush=True)


def save(record, path):
    temporary = pathlib.Path(f"{path}.tmp")
    temporary.write_text(json.dumps(record, indent=1, ensure_ascii=False) + "\n")
    temporary.rename(path)


def identity(row):
    return (row["file"], row["operator"], row["before"], row["after"])


def device_of(build):
    devices = json.loads(subprocess.run([build / "viewer-cli/glint", "devices", "--json"], capture_output=True, text=True, check=True).stdout)
    wanted = os.environ.get("GLINT_DEVICE", "")
    devices = devices if isinstance(devices, list) else devices["devices"]
    return next(d["name"] for n, d in enumerate(devices) if not wanted or wanted == str(n) or wanted.lower() in d["name"].lower())


def run(build, path, jobs, again, budget_s, checks=False):
    """checks: what was found with other programs or other sources counts for nothing."""
    build, path = pathlib.Path(build).resolve(), pathlib.Path(path)
    record = json.loads(path.read_text()) if path.exists() else {}
    tree = mutate.Tree(ROOT / "passes")
    moved = record.get("sources") != tree.digest()
    if moved:
        known = {identity(m): m for m in record.get("mutants", [])}
        record = {**drawn(Bar("making mutants"), known), "control": record.get("control")}
        record["mutants"] = [{**m, **{k: v for k, v in known.get(identity(m), {}).items() if k in OUTCOME and not checks}}
                             for m in record["mutants"]]
        save(record, path)
    programs = list(programs_of(build))
    record["device"] = device_of(build)
    others = [p for p in programs if record["control"] and record["control"].get(p.name, {}).get("version") != p.version]
    again = "all" if checks and (moved or others) else again
    fresh = again == "all" or moved or not record.get("control")
    record["control"] = control(programs, {} if fresh else record["control"], jobs)
    # What unchanged sources fail on this device tells nothing: cases of the self-test, and whole test programs.
    programs = [p for p in programs if p.selftest or not record["control"][p.name]["failing"]]
    for program in programs:
        program.failing = record["control"][program.name]["failing"]
    for m in record["mutants"]:
        if "by" in m:
            OUTCOMES[slot_of(m["file"]), m["by"]].append(True)
    bar = Bar("mutants")
    if again == "all":
        record["mutants"] = [{k: v for k, v in m.items() if k not in OUTCOME} for m in record["mutants"]]
    save(record, path)
    left = [n for n, m in enumerate(record["mutants"]) if "verdict" not in m or again == m["verdict"] and not mutants_page.reason_of(m)]
    done = [len(record["mutants"]) - len(left)]

    def one(n):
        found = attempt(record["mutants"][n], build, programs, record["control"], budget_s)
        with LOCK:
            record["mutants"][n] = found
            done[0] += 1
            bar(done[0], len(record["mutants"]))
            save(record, path)

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, left))
    return record


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    for name in ("run", "check"):
        command = commands.add_parser(name)
        command.add_argument("build")
        command.add_argument("-o", "--record", required=True)
        command.add_argument("--jobs", type=int, default=os.cpu_count())
        command.add_argument("--again", choices=("survived", "all"))
        command.add_argument("--budget", type=float, default=math.inf, help="seconds of programs for a mutant; --again survived goes on with the others, for what no reason is known of")
    page = commands.add_parser("page")
    page.add_argument("records", nargs="+")
    page.add_argument("-o", "--page", required=True)
    arguments = parser.parse_args()
    if arguments.command == "page":
        mutants_page.write(arguments.records, arguments.page)
        return
    record = run(arguments.build, arguments.record, arguments.jobs, arguments.again, arguments.budget, arguments.command == "check")
    killed = sum(m["verdict"] == "killed" for m in record["mutants"])
    print(f"{killed} of {len(record['mutants'])} mutants noticed", file=sys.stderr)
    if arguments.command == "check":
        faults = mutants_page.faults(record)
        print("1..1\n" + "".join(f"# {f}\n" for f in faults) + ("not ok" if faults else "ok") + " 1 - what is wrong is noticed")
        sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
