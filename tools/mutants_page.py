"""The page of mutants.py: what was made and noticed, by slot, operator and mechanism, and why what survived does."""
import collections
import json
import pathlib

import mutant_rows
from pages import table

HEAD = """# Do the tests notice when a shader is wrong?

Written by `tools/mutants.py page`; do not edit. Each [mutant](glossary.md#mutant) is one mechanical change in a file of `passes/`: a comparison
reversed, a constant changed (doubled, 0 to 1), a guard, a clamp or an epsilon removed, a term dropped, signs or axes exchanged. `glint
selftest --quick` and the device tests (`gpu_…`) are run on each until one fails; host code has its own tests. A seed selects the
positions: several in each file, and at least one in each mechanism of [mechanisms.md](mechanisms.md). Changes that do not compile,
and those that compile to the same code, are replaced by others. The unchanged sources pass all tests.
`./dev test --all` generates the mutants again, tests them, and fails if fewer than 85 % of all are noticed, or if one that is not in the table
below survives.
"""


def share(rows):
    killed = sum(m.get("verdict") == "killed" for m in rows)
    return [str(len(rows)), str(killed), f"{100 * killed / len(rows):.0f} %" if rows else "none made"]


def reason_of(m):
    return mutant_rows.HARMLESS.get((m["file"], m["before"], m["after"]))


def missing(m):
    return mutant_rows.MISSING.get((m["file"], m["before"], m["after"]))


def faults(record):
    """What deviates from the expectations."""
    mutants, found = record["mutants"], []
    survivors = [m for m in mutants if m.get("verdict") != "killed"]
    killed = len(mutants) - len(survivors)
    if len(mutants) < 150:
        found.append(f"{len(mutants)} mutants, expected 150 at least")
    if killed < mutant_rows.LEAST * len(mutants):
        found.append(f"{killed} of {len(mutants)} were noticed, expected {mutant_rows.LEAST:.0%}")
    found += [f"{name}: unchanged sources fail {', '.join(c['failing'])}" for name, c in record["control"].items() if c["failing"]]
    found += [f"{p}: no mutant" for p in record["passes"] if not any(p in m["passes"] for m in mutants)]
    found += [f"{k}: no mutant" for k in record["mechanisms"] if not any(k in m["mechanisms"] for m in mutants)]
    found += [f"{m['file']}:{m['line']}: {m['before']} → {m['after']}: survives, and nothing says why" for m in survivors if not reason_of(m) and not missing(m)]
    return found


def grouped(mutants, groups_of):
    groups = collections.defaultdict(list)
    for m in mutants:
        for group in groups_of(m):
            groups[group].append(m)
    return [[name, *share(rows)] for name, rows in sorted(groups.items())]


def code(text):
    return "`" + text.replace("|", "\\|") + "`"


def parted(before, after):
    """Both texts without most of their common beginning and end."""
    first = next((i for i, (a, b) in enumerate(zip(before, after)) if a != b), min(len(before), len(after)))
    last = next((i for i, (a, b) in enumerate(zip(before[::-1], after[::-1])) if a != b), 0)
    last = min(last, len(before) - first, len(after) - first)
    cut = max(0, first - 30)
    end = max(0, last - 30)
    dots = "…" if cut else "", "…" if end else ""
    return [code(dots[0] + t[cut:len(t) - end] + dots[1]) for t in (before, after)]


def of_record(record):
    mutants = [m for m in record["mutants"] if "verdict" in m]
    untried, later = len(record["mutants"]) - len(mutants), [m for m in mutants if "on" in m]
    dates = sorted({m["date"] for m in later if "date" in m})
    survivors = [m for m in mutants if m.get("verdict") != "killed"]
    partly = sum(m.get("untried", 0) > 0 for m in survivors)
    late = sum(m.get("failed", [""])[0].startswith("no end") for m in mutants)
    rejected = ", ".join(f"{n} {what}" for what, n in sorted(record["rejected"].items()))
    harmless, killed = sum(reason_of(m) is not None for m in survivors), len(mutants) - len(survivors)
    without = "; ".join(f"`{name}`: {', '.join(c['failing'])}" for name, c in record["control"].items() if c["failing"])
    lines = [f"## {record['device']}\n", *([f"Left out, because unchanged sources fail there: {without}.\n"] if without else []),
             f"{len(mutants)} mutants, {share(mutants)[1]} noticed ({share(mutants)[2]}), {len(survivors)} not, of which {harmless} are "
             f"harmless: of the others {100 * killed / (len(mutants) - harmless):.0f} % are noticed. Seed {record['seed']}; replaced: {rejected}. "
             f"{late} were noticed because they took {mutant_rows.SLOWER} times as long as unchanged sources and at least half a minute. In total "
             f"{sum(m.get('seconds', 0) for m in mutants) / 60:.0f} minutes of processor time, after {sum(c['seconds'] for c in record['control'].values()) / 60:.0f} "
             f"for unchanged sources; sources {record['sources']}.\n",
             *([f"{untried} more were made and are **not tried** yet.\n"] if untried else []),
             *([f"{len(mutants) - len(later)} were tried on this device, of which {sum(m['verdict'] == 'killed' for m in mutants if 'on' not in m)} were noticed, the others "
                f"later, with the cases written since, on {later[0]['on']} ({', '.join(dates)}): {len(later)}, of which {sum(m['verdict'] == 'killed' for m in later)} were "
                f"noticed. Sources changed in between; a mutant that is still possible keeps its result.\n"] if later else []),
             *([f"{partly} of those not noticed were not tried with every program that uses the file.\n"] if partly else []),
             table(["slot", "mutants", "noticed", "noticed, %"], grouped(mutants, lambda m: {p.split("/")[-2] for p in m["passes"]} if not m["file"].startswith("shared/")
                                                              else {"shared"})),
             table(["what was changed", "mutants", "noticed", "noticed, %"], grouped(mutants, lambda m: [m["operator"]])),
             table(["test or case that notices first", "mutants"], [[f"`{name}`", str(n)] for name, n in
                                                     collections.Counter(m["by"] for m in mutants if "by" in m).most_common()]),
             "Mechanisms of Mafia III's pipeline:\n", table(["mechanism", "mutants", "noticed", "noticed, %"], grouped(mutants, lambda m: m["mechanisms"])),
             "### Mutants that no test notices\n"]
    rows = [[f"`{m['file']}`:{m['line']}", m["operator"], *parted(m["before"], m["after"]), reason_of(m) or (f"**a case is missing**: {missing(m)}" if missing(m) else "**no reason is known**")] for m in survivors]
    return "\n".join(lines + [table(["where", "kind of change", "original", "mutant", "why it is harmless, or what case is missing"], rows).replace("---:", "---")])


def write(records, path):
    report = [json.loads(pathlib.Path(r).read_text()) for r in records]
    pathlib.Path(path).write_text("\n".join([HEAD] + [of_record(r) for r in report]))
