"""The commands that faults.py lets fail, in a folder that has what make_inputs makes, and the kinds of faults."""
import errno
import os
import shutil

import tap

MEMORY, THREAD, DISK = "memory", "thread|Resource temporarily|memory", "No space left|not everything could be written"

# kind of the table: kind of fail.c, the error (0 for the usual one), once or all from there on, and what stderr has to say, one of these
KINDS = {
    "alloc": ("alloc", 0, "once", MEMORY),
    "alloc, all": ("alloc", 0, "all", MEMORY),
    "thread": ("thread", 0, "once", THREAD),
    "thread, all": ("thread", 0, "all", THREAD),
    "mmap": ("mmap", 0, "once", "memory|thread|Resource temporarily"),
    "open EMFILE": ("open", errno.EMFILE, "once", "Too many open files"),
    "open ENOSPC": ("open", errno.ENOSPC, "once", "No space left"),
    "open EMFILE, all": ("open", errno.EMFILE, "all", "Too many open files"),
    "read EIO": ("read", errno.EIO, "once", "Input/output error"),
    "read EIO, all": ("read", errno.EIO, "all", "Input/output error"),
    "read EINTR": ("read", errno.EINTR, "once", "Interrupted system call"),
    "read short": ("read", "short", "once", "^$"),
    "write ENOSPC": ("write", errno.ENOSPC, "once", DISK),
    "write ENOSPC, all": ("write", errno.ENOSPC, "all", DISK),
    "write EIO": ("write", errno.EIO, "once", "Input/output error|not everything could be written"),
    "write EINTR": ("write", errno.EINTR, "once", "Interrupted system call|not everything could be written"),
    "write short": ("write", "short", "once", "^$"),
    "rename EIO": ("rename", errno.EIO, "once", "Input/output error"),
    "sync EIO": ("sync", errno.EIO, "once", "Input/output error"),
    "make ENOSPC": ("make", errno.ENOSPC, "once", "No space left"),
}

COMMANDS = {
    "info": "info tiny.exr",
    "info --json": "info tiny.exr --json",
    "info RUN": "info run",
    "validate": "validate tiny.exr",
    "validate SHOT": "validate shot.0001.exr shot.0002.exr",
    "validate SET": "validate shot.0001.exr shot.0002.exr -o out",
    "lint": "lint tiny.exr",
    "lint SET": "lint shot.0001.exr tiny.exr -o out",
    "merge": "merge linted -o out",
    "plan": "plan tiny.exr -p kf2",
    "passes": "passes",
    "view": "view run -o out.png",
    "diff": "diff run run",
    "set": "set tiny.exr -o out.exr frame=7",
    "crop": "crop tiny.exr 0,0,8,8 -o out.exr",
    "strip": "strip tiny.exr -o out.exr --drop=sky",
    "extract": "extract tiny.exr -o out",
    "pack": "pack loose/manifest.json -o out.exr",
    "export": "export run -o out.exr",
    "report": "report run -o out.html",
    "check": "check run --baseline base",
    "check RUNS": "check part --baseline part -o out",
    "check --approve": "check run --baseline new --approve",
    "devices": "devices",
    "replay": "replay tiny.exr -p kf2 -o out",
    "replay --against": "replay tiny.exr -p plain.json --against truth -o out",
    "replay SHOT": "replay shot.0001.exr shot.0002.exr -p kf2 -o out",
    "replay PART": "replay shot.0001.exr shot.0002.exr -p plain.json -o part",
    "sample": "sample mirror_box -o out.exr --size 8x4 --cube-size 4",
    "probe": "probe tiny.exr 8,6 -p plain.json -o out.svg",
    "explain": "explain run 8,6 --tries 2 -o out.html",
    "stability": "stability tiny.exr -p plain.json --seeds 1 -o out",
    "compare": "compare tiny.exr --presets plain.json,kf2 --repeat 1 -o out",
    "reference": "reference tiny.exr --like plain.json --rays 16 -o out",
    "sweep": "sweep tiny.exr -p plain.json --vary screen_trace.steps=4,8 --repeat 0 --reference truth -o out",
    "tune": "tune tiny.exr -p plain.json --vary screen_trace.steps=4..32 --budget-fetches 50% --repeat 0 --reference truth -o out.json",
    "blame": "blame tiny.exr -p plain.json --rays 16 --player-rays 16 --exact 0 --permutations 2 --repeat 0 --reference truth -o out",
    "selftest": "selftest --quick --only expm1",
    "live": "live tiny.exr -p plain.json -o runs",  # serving.py
    # libraries.c
    "library pack": "pack loose/manifest.json out.exr",
    "library extract": "extract tiny.exr out",
    "library replay": "replay tiny.exr plain.json out",
    "library reference": "reference tiny.exr plain.json out",
    "library judge": "judge tiny.exr plain.json converged",
}

# A fault of these takes many replays: in a sample they have fewer, or are left to longer runs.
LONG = {"replay SHOT", "replay --against", "library replay", "report", "selftest"}
LONGEST = {"compare", "live", "probe", "replay PART", "reference", "sweep", "tune", "blame", "stability", "explain", "library reference"}


def make_inputs(folder):
    """What the commands read, in files small enough that every call of a command can fail once."""
    size = ("--size", "16x9", "--cube-size", "8")
    with open(tap.PLAIN, encoding="utf-8") as file, open(os.path.join(folder, "plain.json"), "w", encoding="utf-8") as copy:
        copy.write(file.read())
    tap.glint("sample", "still_life", "-o", "shot.exr", *size, "--frames", "2", folder=folder)
    tap.glint("sample", "still_life", "-o", "tiny.exr", *size, "--truth", "1", folder=folder)
    tap.glint("replay", "tiny.exr", "-p", "plain.json", "-o", "run", folder=folder)
    tap.glint("replay", "shot.0001.exr", "shot.0002.exr", "-p", "plain.json", "-o", "part", folder=folder)
    shutil.rmtree(os.path.join(folder, "part", "shot.0002"))  # as if the replay had been interrupted
    tap.glint("reference", "tiny.exr", "--like", "plain.json", "--rays", "16", "-o", "converged", folder=folder)
    tap.glint("check", "run", "--baseline", "base", "--approve", folder=folder)
    tap.glint("extract", "tiny.exr", "-o", "loose", folder=folder)
    for share in ("1/2", "2/2"):
        tap.glint("lint", "shot.0001.exr", "tiny.exr", "-o", "linted", "--shard", share, folder=folder)
