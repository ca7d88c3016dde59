#!/usr/bin/env python3
"""docs/mutants.md: whether the self-test and the device tests notice when passes/ is wrong.

mutants.py draw -o RECORD                      makes the mutants, for a machine that has no compiler of shaders
mutants.py run BUILD -o RECORD [--jobs N]      tries each mutant; goes on where a record of the same sources and programs ends
mutants.py check BUILD -o RECORD               the same, and speaks TAP (./dev test --all)
mutants.py retry BUILD -o RECORD [--most S]    tries on this device what a record of any device leaves open: mutants that were not tried, and those
                                               that lack a case; each for S seconds of processor time
mutants.py page RECORD... -o PAGE              the page of those records

The changed file lies alone in a folder from which the programs take passes ($GLINT_PASSES). A mutant is tried with each program that uses the
file until one fails. A control run of unchanged sources, which must pass, finds the files that each program opens. The program that failed in the
previous record comes first, then those with the highest chance to fail per second of processor time. A record of other sources or
programs changes this order alone, never a result."""
import argparse
import collections
import concurrent.futures
import datetime
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
from mutant_rows import ARGUED_S, AT_LEAST_S, HANGS, SLOWER

ROOT = pathlib.Path(__file__).resolve().parent.parent
ENVIRONMENT = {"GLINT_CACHE": "none", "CMOCKA_MESSAGE_OUTPUT": "TAP", "GLINT_REQUIRE_DEVICE": "1", "GLINT_TEST_UNCHECKED": "1"}
HOST_TEST = "test_cubemap_active"


# ---- Programs ----

class Program:
    """A program that may notice a mutant: its name, and how to run it."""

    def __init__(self, name, command, selftest=False):
        self.name, self.command, self.selftest = name, [str(c) for c in command], selftest
        self.case = ""  # ": CASE" if it is the only one
        self.failing = []  # cases that are ignored

    def only(self, case):
        """The self-test with only the case of this name."""
        program = Program(self.name, [*self.command[:4], "--only", case], True)
        program.case, program.failing = f": {case}", self.failing
        return program

    def run(self, passes, limit_s, to_end=False):
        """A list of failed cases (the first, unless to_end), the number of cases, and seconds of processor time."""
        with tempfile.TemporaryDirectory(prefix="gm") as folder:
            environment = {**os.environ, **ENVIRONMENT, "GLINT_PASSES": str(passes), "TMPDIR": folder}
            limits = ["prlimit", f"--cpu={math.ceil(limit_s)}", "stdbuf", "-oL"]
            process = subprocess.Popen([*limits, *self.command], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                       env=environment, start_new_session=True, errors="replace")
            late = threading.Timer(HANGS * limit_s, self.stop, [process])  # a device that hangs uses no processor time
            late.start()
            failed, cases = (self.read_json if self.selftest else self.read_tap)(process, to_end)
            if failed and not to_end:
                self.stop(process)
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            over = not late.is_alive()
            late.cancel()
            process.stdout.close()
        if over or process.returncode == -signal.SIGXCPU:
            failed = [f"no end in {limit_s:.0f} s"]
        elif not failed and process.returncode not in (range(2 if self.selftest else len(self.failing) + 1)):
            failed = [f"exit status {process.returncode}"]
        return failed, cases, used.ru_utime + used.ru_stime

    @staticmethod
    def stop(process):
        """Its process group may be gone already."""
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass

    def read_tap(self, process, to_end):
        failed, cases, planned = [], 0, None
        for line in process.stdout:
            if line.startswith("not ok"):
                failed.append(re.sub(r"^not ok \d+ - ", "", line).strip().replace("_", " "))
                if failed[-1] not in self.failing and not to_end:
                    return failed[-1:], cases
            cases += bool(re.match(r"(not )?ok \d+", line)) and "# SKIP" not in line
            planned = int(line[3:]) if re.fullmatch(r"1\.\.\d+\n", line) else planned
        return [f for f in failed if f not in self.failing] or ([] if cases == planned else [f"{cases} of {planned} cases"]), cases

    def read_json(self, process, _):
        text = process.stdout.read()
        cases = json.loads(text)["cases"] if text.startswith("{") else []
        return ([c["name"] for c in cases if not c["pass"] and c["name"] not in self.failing] if cases else ["no answer"]), len(cases)


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


def version_of(build, programs):
    """A hash of everything that runs."""
    files = {p.command[0] for p in programs} | {str(p) for folder in ("capture-format", "replay") for p in (build / folder).glob("*.so")}
    return hashlib.sha256(b"".join(pathlib.Path(f).read_bytes() for f in sorted(files))).hexdigest()[:16]


# ---- Control ----

def opened(folder):
    return [p.relative_to(folder).as_posix() for p in folder.rglob("*.*") if p.is_file() and p.stat().st_atime > 1]


def control_of(program):
    """The program's time on unchanged sources, and the files that it opens. A file was opened if its access time changed, which a file
    system with relatime updates if it was older than the last modification."""
    with tempfile.TemporaryDirectory(prefix="gm") as folder:
        passes = pathlib.Path(folder) / "passes"
        shutil.copytree(ROOT / "passes", passes)
        for path in passes.rglob("*.*"):
            os.utime(path, (1, time.time()))
        failed, cases, seconds = program.run(passes, 600, to_end=True)
        files = opened(passes)
    return {"seconds": round(seconds, 2), "cases": cases, "failing": failed or ([] if cases else ["no cases"]),
            "files": sorted(f for f in files if f.endswith((".glsl", ".comp")))}


def control(programs, jobs):
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        report = dict(zip([p.name for p in programs], pool.map(control_of, programs)))
    if not any(t["files"] for t in report.values()):
        sys.exit("mutants: the file system does not tell which files were opened; set TMPDIR to one that does (relatime)")
    return report


# ---- Mutants ----

def key_of(source, mutant):
    """A key that identifies a mutant in other versions of its file."""
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
    """Host code is linked into its test again."""
    program = f"{folder}/{HOST_TEST}"
    archives = sorted(str(p) for p in (build / "passes").glob("*.a")) + sorted(str(p) for p in (build / "capture-format").glob("*.so"))
    subprocess.run(["cc", "-std=c11", "-D_POSIX_C_SOURCE=200809L", "-D_DEFAULT_SOURCE", "-g", "-I", ROOT / "passes/include", "-I", build / "passes/include", "-I", ROOT / "tests", "-I",
                    ROOT / "capture-format/include", "-o", program, ROOT / f"tests/passes/{HOST_TEST}.c", write_mutant(row, folder), *archives,
                    f"-Wl,-rpath,{build / 'capture-format'}", "-lcmocka", "-lm"], check=True)
    return Program(HOST_TEST, [program]).run(folder, AT_LEAST_S)


LOCK, OUTCOMES = threading.Lock(), collections.defaultdict(list)  # of programs, by the slot of what they were tried on


OUTCOME = ("verdict", "by", "failed", "seconds", "untried", "on", "date")


def slot_of(file):
    return file if file.startswith("shared/") else file.split("/")[-2]


def opens(control, row):
    """Whether a program uses the mutant's file: itself, or a shader that includes it."""
    return not {row["file"], *(f"{p}.comp" for p in row["passes"])}.isdisjoint(control["files"])


def likeliest(programs, row, report):
    """The programs that use the file: first those named after its slot, then by their chance to fail per second, as measured so far."""
    file = row["file"]

    def is_own(program):
        words = {"shared": "functions", "temporal": "time", "temporal_sharp": "time", "previous_frame": "time", "screen_trace": "geometry",
                 "screen_rays": "geometry", "cubemap_trace": "geometry"}
        slot = "shared" if file.startswith("shared/") else file.split("/")[-2]
        return slot in program.name or words.get(slot, slot) in program.name

    def chance(program):
        with LOCK:
            found = OUTCOMES[slot_of(file), program.name]
            return (sum(found) + 0.3) / (len(found) + 1) / report[program.name]["seconds"]

    return sorted((p for p in programs if opens(report[p.name], row)), key=lambda p: (is_own(p), chance(p)), reverse=True)


def in_order(row, programs, report):
    """The program that failed before, of the self-test only the case that failed; then the others. If it is explained why none fails, they
    get a minute in all."""
    others, spent_s = likeliest(programs, row, report), 0
    by, failed = row.get("before_by"), row.get("before_failed", [""])
    for program in (p for p in others if p.name == by):
        yield program.only(failed[0]) if program.selftest and failed[0] in program.command else program
    for program in others:
        if mutants_page.reason_of(row) and spent_s >= ARGUED_S:
            return
        spent_s += report[program.name]["seconds"]
        if program.name != by or program.selftest:
            yield program


def attempt(row, build, programs, report, passes_here=lambda program: True, most_s=math.inf):
    """The row with its result. passes_here: whether a program passes with unchanged sources; it is asked for those that fail. After most_s seconds of
    processor time no other program is begun."""
    failed, by, spent_s, tried = [], None, 0, set()
    with tempfile.TemporaryDirectory(prefix="gm") as folder:
        if row["file"].endswith(".c"):
            (failed, _, spent_s), by = try_host(row, folder, build), HOST_TEST
        else:
            write_mutant(row, folder)
            for program in in_order(row, programs, report):
                if tried and spent_s + report[program.name]["seconds"] > most_s:
                    break
                failed, _, seconds = program.run(folder, max(AT_LEAST_S, SLOWER * report[program.name]["seconds"]))
                spent_s += seconds
                by = program.name
                tried.add(by)
                failed = failed if failed and passes_here(program) else []
                with LOCK:
                    OUTCOMES[slot_of(row["file"]), by] += [bool(failed)]
                if failed:
                    break
    made = {k: v for k, v in row.items() if k not in OUTCOME}
    untried = sum(opens(report[p.name], row) and p.name not in tried for p in programs)
    return {**made, "verdict": "killed" if failed else "survived", **({"by": by, "failed": failed} if failed else {"untried": untried}),
            "seconds": round(spent_s, 1)}


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


def with_mutants(path):
    """The record at `path` when it is of these sources, else a new one, with what noticed the same mutants before."""
    record = json.loads(path.read_text()) if path.exists() else {}
    if record.get("sources") == mutate.Tree(ROOT / "passes").digest():
        return record
    known = {identity(m): m for m in record.get("mutants", [])}
    record = drawn(Bar("making mutants"), known)
    for m in record["mutants"]:
        before = known.get(identity(m), {})
        m.update({f"before_{k}": before[k] for k in ("by", "failed") if before.get("verdict") == "killed"})
    save(record, path)
    return record


def begun(build, path, programs, jobs):
    """The record to continue: without results, unless they are of these programs and this device."""
    record, of = with_mutants(path), {"programs": version_of(build, programs), "device": device_of(build)}
    if record.items() >= of.items():
        return record
    for m in record["mutants"]:
        if m.get("verdict") == "killed":
            m.update(before_by=m["by"], before_failed=m["failed"])
        for k in OUTCOME:
            m.pop(k, None)
    record.update(of, control=control(programs, jobs))
    save(record, path)
    return record


def run(build, path, jobs):
    build, path = pathlib.Path(build).resolve(), pathlib.Path(path)
    programs = list(programs_of(build))
    record = begun(build, path, programs, jobs)
    # Cases that fail with unchanged sources on this device are ignored.
    for program in programs:
        program.failing = record["control"][program.name]["failing"]
    for m in record["mutants"]:
        OUTCOMES[slot_of(m["file"]), m.get("by", m.get("before_by"))].append(True)
    bar = Bar("mutants")
    left = [n for n, m in enumerate(record["mutants"]) if "verdict" not in m]

    def one(n):
        found = attempt(record["mutants"][n], build, programs, record["control"])
        with LOCK:
            record["mutants"][n] = found
            bar(sum("verdict" in m for m in record["mutants"]), len(record["mutants"]))
            save(record, path)

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, left))
    return record


def carried(path):
    """The record with the mutants of these sources; those that it has already keep their results."""
    before = json.loads(path.read_text())
    record = with_mutants(path)
    known = {identity(m): m for m in before["mutants"]}
    for m in record["mutants"]:
        m.update({k: known[identity(m)][k] for k in OUTCOME if k in known.get(identity(m), {})})
    return {**before, **record}


def retry(build, path, jobs, most_s):
    build, path = pathlib.Path(build).resolve(), pathlib.Path(path)
    programs, record = list(programs_of(build)), carried(path)
    here, asked = record.setdefault("here", {}), threading.Lock()  # controls on this device
    on = {"on": device_of(build), "date": datetime.date.today().isoformat()}

    def passes_here(program):
        with asked:
            version, name = version_of(build, [program]), program.name + program.case
            if here.get(name, {}).get("version") != version:
                here[name] = {**control_of(program), "version": version}
            return not here[name]["failing"]

    for m in record["mutants"]:
        if "by" in m or "before_by" in m:
            OUTCOMES[slot_of(m["file"]), m.get("by", m.get("before_by"))].append(True)
    open_ = [n for n, m in enumerate(record["mutants"]) if "verdict" not in m or m["verdict"] == "survived" and not mutants_page.reason_of(m)]
    open_.sort(key=lambda n: "verdict" in record["mutants"][n])
    save(record, path)

    def one(n):
        found = {**attempt(record["mutants"][n], build, programs, {**record["control"], **here}, passes_here, most_s), **on}
        with LOCK:
            record["mutants"][n] = found
            print(f"{found['file']}:{found['line']}: {found['verdict']} {found.get('by', '')} {found['seconds']} s", file=sys.stderr, flush=True)
            save(record, path)

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, open_))
    return record


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("draw").add_argument("-o", "--record", required=True)
    for name in ("run", "check", "retry"):
        command = commands.add_parser(name)
        command.add_argument("build")
        command.add_argument("-o", "--record", required=True)
        command.add_argument("--jobs", type=int, default=os.cpu_count())
        if name == "retry":
            command.add_argument("--most", type=float, default=math.inf, help="seconds of processor time for a mutant")
    page = commands.add_parser("page")
    page.add_argument("records", nargs="+")
    page.add_argument("-o", "--page", required=True)
    arguments = parser.parse_args()
    if arguments.command == "page":
        mutants_page.write(arguments.records, arguments.page)
        return
    if arguments.command == "draw":
        with_mutants(pathlib.Path(arguments.record))
        return
    if arguments.command == "retry":
        record = retry(arguments.build, arguments.record, arguments.jobs, arguments.most)
    else:
        record = run(arguments.build, arguments.record, arguments.jobs)
    killed = sum(m.get("verdict") == "killed" for m in record["mutants"])
    print(f"{killed} of {len(record['mutants'])} mutants noticed", file=sys.stderr)
    if arguments.command == "check":
        faults = mutants_page.faults(record)
        print("1..1\n" + "".join(f"# {f}\n" for f in faults) + ("not ok" if faults else "ok") + " 1 - what is wrong is noticed")
        sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
