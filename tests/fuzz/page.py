"""docs/fuzzing.md, from fuzzing.md.in and the records of runs."""
import json
import pathlib
import re

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def table(head, rows, right):
    """Columns from `right` on hold numbers."""
    lines = ["| " + " | ".join(head) + " |", "| " + " | ".join("---:" if i >= right else "---" for i in range(len(head))) + " |"]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def reads(target):
    """What the target's file says of itself."""
    comment = re.match(r"/\* (.*?) \*/", (HERE / f"{target}.c").read_text(), re.DOTALL)[1]
    return re.sub(r"\s+", " ", comment).removeprefix("Fuzzes ").split(". ")[0].split(": ")[0].rstrip(".")


def added(records):
    """Counts of all records together; what is reached is that of the record that reaches most."""
    targets = {}
    for record in records:
        for name, own in record["targets"].items():
            sums = targets.setdefault(name, {"executions": 0, "seconds": 0, "found": 0, "edges": 0})
            for key in ("executions", "seconds", "found"):
                sums[key] += own[key]
            if own.get("edges", 0) > sums["edges"]:
                sums.update({key: own[key] for key in ("edges", "edges_all", "functions", "functions_all", "corpus", "files")})
    return targets


def figures(targets):
    rows = []
    for name, own in sorted(targets.items()):
        reached = [f"{own['edges']:,} of {own['edges_all']:,}", f"{100 * own['edges'] / own['edges_all']:.0f} %",
                   f"{own['functions']} of {own['functions_all']}", own["corpus"]] if own["edges"] else ["–"] * 4
        rows.append([f"`{name}`", reads(name), f"{own['executions']:,}", f"{own['executions'] / max(own['seconds'], 1):,.0f}", *reached, own["found"]])
    sums = [sum(own[key] for own in targets.values()) for key in ("executions", "seconds", "found")]
    rows.append(["all", "", f"{sums[0]:,}", f"{sums[0] / max(sums[1], 1):,.0f}", "", "", "", "", sums[2]])
    head = ["target", "what it reads", "executions", "a second", "edges reached", "of all", "functions", "corpus", "found"]
    return table(head, rows, 2)


def files(targets):
    """Each file at the target that reaches most of it."""
    best = {}
    for name, own in sorted(targets.items()):
        for path, (reached, everything) in own.get("files", {}).items():
            if path not in best or reached > best[path][0]:
                best[path] = (reached, everything, name)
    rows = [[f"`{path}`", f"`{name}`", reached, everything, f"{100 * reached / everything:.0f} %"] for path, (reached, everything, name) in sorted(best.items())]
    return table(["file", "target", "edges reached", "edges", "of all"], rows, 2)


def write():
    records = [json.loads(path.read_text()) for path in sorted((ROOT / "tools/records/fuzz").glob("*.json"))]
    targets = added(records)
    text = (HERE / "fuzzing.md.in").read_text()
    hours = sum(own["seconds"] for own in targets.values()) / 3600
    for name, made in (("FIGURES", figures(targets)), ("FILES", files(targets)), ("HOURS", f"{hours:.1f}")):
        text = text.replace(f"@{name}@", made)
    (ROOT / "docs/fuzzing.md").write_text(text)
    return 0
