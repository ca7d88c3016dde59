"""Every allocation, thread and system call of glint's commands fails once, by the library of fail.c: what fails well, and what does not.
PROGRAM is that of libraries.c, which calls glint's libraries without glint.

faults.py GLINT LIBRARY PROGRAM [--all | --stacks N | --samples N] [--only COMMAND[:KIND]] [--from N] [--to N] [--where] [--record FILE] [--page FILE]

--all lets every call fail. Most calls are made by loops, so a command with forty thousand allocations has a thousand different stacks of
calls: --stacks N tries the first (1), also the last (2), and also the middle (3) call of each. Otherwise it is a sample.

One fault has failed well if the command

- ends with another status than 0, and not by a signal; says on stderr that it is out of memory, or the system's error with the name of a
  file; and leaves all files as they were (none under a final name that was not there before, none changed, no temporary file) or all of
  them whole, as without the fault, if it failed afterwards; or
- ends as without the fault, with the same bytes on stdout and the same files, byte for byte (glint live: answers each request as without the fault, or
  refuses it and says why, and answers all that follow). Where two runs without a fault differ, as in times, numbers with their units and the spaces
  between columns are not compared;

and, if main returned, no more of glint's own memory is left allocated, and no more files are open, than without the fault.

It has failed badly if it ended by a signal, ran past the limit, was silent about what happened, printed or wrote something else and ended with 0,
left a file, or leaks.
"""
import argparse
import collections
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
from commands import COMMANDS, KINDS, LONG, LONGEST, make_inputs
import serving
import tap
from process import Process
from serving import Serving
from table import Table

NUMBER = re.compile("[0-9]+([.][0-9]+)?(e-?[0-9]+)?( (ns|µs|ms|s)\\b)?|[ ─█▏▎▍▌▋▊▉]+".encode())
# Without memory Jansson 2.14 reads something else than the text has, or writes past the end of a string: that is not glint's to mend, and the
# program glint has a reserve for it.
JANSSON_READS = "json_load"
# What OpenEXRCore 3.1 (exr_add_part) forgets a block or two of when it lacks memory, and the function of glint that it is allocated for.
FORGETFUL = (("libOpenEXRCore", "glint_exr_memory_take"),)
# glslang throws where it lacks memory while it starts, and cannot be ended then, in which state everything that it has allocated stays.
UNENDED = "glslang cannot start"
# What a command that goes on where it was interrupted may keep, whole as it is without the fault, and uses then.
GROWS = {"replay --against", "sweep", "tune", "blame", "reference", "library reference"}  # by errors, pages, logs and rays
# These have a journal, out/log.jsonl, and its definition, until they are finished.
JOURNALS = {name: {f"out/{name.split()[0]}.json", "out/log.jsonl"} for name in ("compare", "lint SET", "validate SET", "check RUNS", "merge")}
JOURNALS["merge"].add("out/lint.json")  # of the command whose shards are merged
ROWS = {"lint SET", "validate SET", "check RUNS", "merge"}
KEEPS = {"live", "replay SHOT", "replay PART", "explain", "stability", *JOURNALS, *GROWS}


class Command:
    """One command, and what it does without a fault."""

    def __init__(self, options, name, inputs, folder):
        self.options, self.name = options, name
        library = name.startswith("library")
        self.program = options.program if library else options.glint
        make = Serving if name == "live" else Process
        self.process = make(self.program, options.library, COMMANDS[name].split(), library and JANSSON_READS, inputs, folder)
        first = self.process.run("any", how="stacks" if options.stacks or options.record else "once")
        assert first.status == 0, (name, first.status, first.err)
        self.stacks = {kind: self.count(kind, first) for kind, *_ in KINDS.values()}
        second = self.process.run()
        self.varies = {"": first.out != second.out}
        self.varies.update({path: first.files[path] != second.files.get(path) for path in first.files})
        self.whole = first

    def count(self, kind, outcome):
        """The stack of each call of this kind, of a run without a fault; in a sample 0, as they take long."""
        return self.process.stacks(kind) if self.options.stacks or self.options.record else [0] * outcome.calls(kind)

    def same(self, path, one, other):
        if one is None or other is None:
            return one is other
        return self.same_text(one, other) if self.varies[path] else one == other

    def same_text(self, one, other):
        return NUMBER.sub(b"#", one) == NUMBER.sub(b"#", other)

    def same_files(self, files):
        return files.keys() == self.whole.files.keys() and all(self.same(path, files[path], self.whole.files[path]) for path in files)

    def may_leave(self, files, words):
        """Nothing, all, or, where a command goes on later, whole files alone. Of many captures, one that cannot be read is a row of the result, which says why."""
        before = self.process.before
        if files == before or self.same_files(files):
            return True
        new = [path for path in files if before.get(path, b"") != files[path] or path not in before]
        new = [path for path in new if path not in JOURNALS.get(self.name, ())]
        if self.name in ROWS and new == ["out/", "out/results.json"] and re.search(words, files[new[1]].decode()):
            return True
        whole, grows = self.whole.files, self.name in GROWS
        return self.name in KEEPS and before.keys() <= files.keys() and all(path in whole and (grows or self.same(path, files[path], whole[path])) for path in new)

    def leaked(self, outcome):
        """What is left at the end and was not left without the fault."""
        if not re.search("^calls ", outcome.report, re.M) or UNENDED in outcome.err:
            return []
        left = sorted((collections.Counter(outcome.left()) - collections.Counter(self.whole.left())).elements())
        return [] if len(left) < 3 and any(self.forgets(outcome, line, *names) for line in left for names in FORGETFUL) else left

    def forgets(self, outcome, line, library, function):
        """Whether it was a library that forgot the block, when one of its own allocations failed."""
        own = any(library in path for path, _ in outcome.stack()[:2])
        return own and line.startswith("left") and self.functions([line.split()[1:]], 1)[0].startswith(function)

    def judge(self, outcome, words, once="once"):
        """What is bad about it, or None."""
        whole = self.whole
        if outcome.status is None:
            return "hangs"
        if outcome.status < 0:
            return f"signal {-outcome.status}"
        if outcome.status == 0 and not self.same("", outcome.out, whole.out):
            return "exit 0, other output"
        if outcome.status == 0 and not self.same_files(outcome.files) and self.name != "live":
            return "exit 0, other files"
        if not self.may_leave(outcome.files, words):
            return "leaves files"
        wrong = self.name == "live" and serving.judge(outcome, whole, words, self.same_text, once == "once")
        if wrong:
            return wrong
        said = outcome.err + outcome.out.decode(errors="replace") * (self.name in {"validate", "validate SHOT", *ROWS})
        if outcome.status and not re.search(words, said):
            return "does not say why"
        return "leaks" if self.leaked(outcome) else None

    def functions(self, frames, most):
        """The names and places of what is glint's own of these calls."""
        lines = []
        for path, offset in frames:
            if path != "-" and "libglint-" not in path:
                continue
            path = self.program if path == "-" else path
            found = subprocess.run(["addr2line", "-fse", path, offset], capture_output=True, text=True, check=False).stdout.split()
            lines.append(f"{found[0]} {found[1]}" if len(found) > 1 else f"{path}+{offset}")
            if len(lines) == most:
                break
        return lines or ["?"]

    def explained(self, outcome):
        """The call that failed and who made it, and what leaked."""
        text = " < ".join(self.functions(outcome.stack(), 5))
        leaked = collections.Counter(self.leaked(outcome))
        for line, times in list(leaked.items())[:6]:
            words = line.split()
            text += f"; left {times}: " + (self.functions([words[1:]], 1)[0] if words[0] == "left" else line)
        return text


def spread(count, samples, seed):
    """Of a few equal stretches one call each."""
    step = count / samples
    return sorted({min(count, int(i * step + (seed * 0.37 + i * 0.61) % 1 * step) + 1) for i in range(samples)})


def of_stacks(stacks, most):
    """The first, last and middle call of each stack, or the first alone."""
    where = collections.defaultdict(list)
    for number, stack in enumerate(stacks, 1):
        where[stack].append(number)
    chosen = set()
    for numbers in where.values():
        chosen.update([numbers[0], numbers[-1], numbers[len(numbers) // 2]][:most])
    return sorted(chosen)


def samples(options, name, label):
    """How many calls of this kind are in a sample of a command: half of all are allocations, and of the other kinds each command has every other one."""
    if options.everything or options.stacks:
        return None
    if name in LONGEST and not options.only:
        return 0
    if label == "alloc":
        return max(2, options.samples // 40) if name in LONG else options.samples // 2
    turn = list(COMMANDS).index(name) + list(KINDS).index(label)
    return max(1, options.samples // 28) if turn % (8 if name in LONG else 2) == 0 else 0


def numbers(options, name, label, stacks, seed):
    """Which calls fail."""
    chosen, most = range(1, len(stacks) + 1), samples(options, name, label)
    if options.stacks:
        chosen = of_stacks(stacks, options.stacks)
    elif most is not None and len(stacks) > most:
        chosen = spread(len(stacks), most, seed)
    return [n for n in chosen if (options.begin or 1) <= n <= (options.end or n)][:: options.every]


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("glint", type=os.path.abspath)
    parser.add_argument("library", type=os.path.abspath)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("--all", action="store_true", dest="everything", help="every call")
    parser.add_argument("--stacks", type=int, choices=(1, 2, 3), help="the first, last and middle call of each stack of calls")
    parser.add_argument("--samples", type=int, default=14, help="faults of a command, about")
    parser.add_argument("--only", default="")
    parser.add_argument("--from", type=int, dest="begin")
    parser.add_argument("--to", type=int, dest="end")
    parser.add_argument("--every", type=int, default=1, help="of what would be tried, only each N-th")
    parser.add_argument("--where", action="store_true", help="print each fault that failed badly")
    parser.add_argument("--record", help="a file that keeps the table: rows that were tried now replace those that it has")
    parser.add_argument("--page", help="write the table of the record as a page")
    return parser.parse_args()


def how(options):
    which = "each call" if options.everything else "sample"
    if options.stacks:
        which = ("first", "first and last", "first, middle and last")[options.stacks - 1] + " call of each stack"
    return which + (f", one in {options.every}" if options.every > 1 else "")


def try_kind(options, table, command, label, seed):
    kind, error, once, words = KINDS[label]
    if samples(options, command.name, label) == 0:
        return
    stacks = command.stacks[kind]
    chosen = numbers(options, command.name, label, stacks, seed)
    table.begin(command.name, label, len(stacks), len(set(stacks) - {0}), how(options))
    for number in chosen:
        outcome = command.process.run(kind, number, error, once)
        if not outcome.stack():  # threads: fewer calls this time
            continue
        bad = command.judge(outcome, words, once)
        table.add(command.name, label, number, bad, lambda: command.explained(outcome))
        if bad and options.where:
            print(f"# {command.name}: {label} {number} of {len(stacks)}: {bad}, exit {outcome.status}: {outcome.err[-200:].strip()!r}; "
                  f"{command.explained(outcome)}", flush=True)


def try_command(options, table, name, inputs, folder):
    command = Command(options, name, inputs, folder)
    only = options.only.split(":")[1] if ":" in options.only else ""
    try:
        for seed, label in enumerate(KINDS):
            if label == only or not only:
                try_kind(options, table, command, label, seed + list(COMMANDS).index(name))
    finally:
        command.process.stop()


def main():
    options = arguments()
    sys.argv[1] = options.glint  # for tap
    table = Table(options.record)
    folder = tempfile.mkdtemp(prefix="glint-faults-")
    try:
        inputs = os.path.join(folder, "inputs")
        os.mkdir(inputs)
        make_inputs(inputs)
        names = [name for name in COMMANDS if options.only.split(":")[0] in ("", name) and samples(options, name, "alloc") != 0]
        print(f"1..{len(names)}", flush=True)
        for i, name in enumerate(names, 1):
            before, start = table.bad(), tap.cpu_seconds()
            try_command(options, table, name, inputs, folder)
            table.write()
            print(f"{'ok' if table.bad() == before else 'not ok'} {i} - {name}\n# {tap.cpu_seconds() - start:.1f} s of CPU", flush=True)
    finally:
        shutil.rmtree(folder)
        table.print()
        if options.page:
            table.write_page(options.page, COMMANDS)
    return table.bad() > 0


if __name__ == "__main__":
    sys.exit(main())
