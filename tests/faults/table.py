"""The table of faults: for each command and kind what was tried, and how it went; printed, kept in a record, and written as a page."""
import json
import os
import sys

PAGE = """# Faults

What happens to the commands of glint when an allocation, a thread or a system call fails. `tests/faults/fail.c` is a library that lets the n-th
call of a kind fail, or all from the n-th on, in a process of `glint`; `tests/faults/faults.py` runs each command with one fault after the other,
on captures of 16×9 pixels, and judges what came of it. This page is made by

```sh
./dev faults        # each stack of calls: its first, last and middle call
./dev faults --all  # each call
```

which replace the rows of commands that they try, and take hours. `--only COMMAND` of `faults.py` tries one, `--stacks 1 --every N` one in N of
the first calls of each stack, which a row then says, and the test `faults` a sample of all. {left}

A fault was handled **well** if the command ended with a message that says why and left no file that is not whole, or did what it does without
the fault; and in both cases nothing that glint allocated was left, and no file was open, that is not there without the fault. Everything else
is **badly**: a signal, a hang, another output with status 0, a file, silence, a leak. Of {tried} faults {well} were handled well and {badly} badly.

**Calls** are the allocations that a command makes, and **stacks** the different stacks of calls that they are made from, as most calls are made by
loops. The columns of kinds have the faults that were tried, and in bold those that were handled badly. *All* is a machine that is out of memory: that
allocation and all later ones fail. What Jansson allocates while it reads does not fail in the rows of libraries, as Jansson 2.14 then reads
something else or writes past the end of a string; the program has a reserve of memory for it (`viewer-cli/io/memory.c`).

| Command | Which calls | Calls | Stacks | {kinds} | Tried | Well | Badly |
|---|---|--:|--:|{lines}--:|--:|--:|
{rows}
"""
COLUMNS = ("alloc", "alloc, all", "thread", "mmap", "open", "read", "write", "rename", "sync", "make")


def column(kind):
    """The column of the page that a kind of fault is counted in."""
    return kind if kind == "alloc, all" else kind.split()[0].rstrip(",")


class Table:
    def __init__(self, record):
        self.record, self.rows, self.now, self.first = record, {}, set(), {}
        if record and os.path.exists(record):
            with open(record, encoding="utf-8") as file:
                self.rows = {(row["command"], row["kind"]): row for row in json.load(file)}

    def begin(self, command, kind, calls, stacks, how):
        self.now.add((command, kind))
        self.rows[command, kind] = {"command": command, "kind": kind, "calls": calls, "stacks": stacks, "how": how, "tried": 0, "badly": 0}

    def add(self, command, kind, number, bad, explain):
        row = self.rows[command, kind]
        row["tried"] += 1
        row["badly"] += bool(bad)
        if bad and (command, kind, bad) not in self.first:
            self.first[command, kind, bad] = number, explain()

    def tried_now(self):
        return [row for key, row in self.rows.items() if key in self.now]

    def bad(self):
        return sum(row["badly"] for row in self.tried_now())

    def print(self):
        print(f"# {'command':16} {'kind':18} {'calls':>7} {'stacks':>7} {'tried':>7} {'well':>7} {'badly':>7}")
        rows = self.tried_now()
        for row in rows:
            print(f"# {row['command']:16} {row['kind']:18} {row['calls']:7} {row['stacks']:7} {row['tried']:7} {row['tried'] - row['badly']:7} {row['badly']:7}")
        tried, badly = (sum(row[name] for row in rows) for name in ("tried", "badly"))
        print(f"# {'all':16} {'':18} {'':7} {'':7} {tried:7} {tried - badly:7} {badly:7}")
        for (command, kind, bad), (number, explained) in self.first.items():
            print(f"# {command}: {kind} {number}: {bad}; in {explained}")
        sys.stdout.flush()

    def write(self):
        if self.record:
            with open(self.record, "w", encoding="utf-8") as file:
                file.write("[\n" + ",\n".join(json.dumps(row) for row in self.rows.values()) + "\n]\n")

    def write_page(self, path, commands):
        lines, rows = [], [row for row in self.rows.values() if row["tried"]]
        for command in dict.fromkeys(row["command"] for row in rows):
            own = [row for row in rows if row["command"] == command]
            tried, badly = (sum(row[name] for row in own) for name in ("tried", "badly"))
            of = {name: [row for row in own if column(row["kind"]) == name] for name in COLUMNS}
            cells = [f"{sum(row['tried'] for row in of[name]):,}" + "".join(f" **{n}**" for n in [sum(row["badly"] for row in of[name])] if n) for name in COLUMNS]
            first = own[0]
            lines.append(f"| {command} | {first['how']} | {first['calls']:,} | {first['stacks']:,} | {' | '.join(cells)} | {tried:,} | {tried - badly:,} | {badly:,} |")
        tried, badly = (sum(row[name] for row in rows) for name in ("tried", "badly"))
        with open(path, "w", encoding="utf-8") as file:
            left = [name for name in commands if name not in {row["command"] for row in rows}]
            file.write(PAGE.format(left="This record lacks " + ", ".join(left) + "." if left else "", tried=f"{tried:,}", well=f"{tried - badly:,}", badly=f"{badly:,}", kinds=" | ".join(COLUMNS), lines="--:|" * len(COLUMNS), rows="\n".join(lines)))
