"""Finds a frame's passes by what their shaders read and write, in the list that list_passes.py prints."""
from expressions import suggest

KEYS = {"samplers", "not_samplers", "cube_samplers", "outputs", "output_names", "constants", "depth", "size", "kind", "draws_at_least", "reads_output_of", "pick", "comment"}


class FindError(Exception):
    """No pass, or more than one, fits a rule; `key` is the rule's key that is to blame, or ""."""

    def __init__(self, key, message):
        super().__init__(message)
        self.key = key


def samplers_of(entry):
    return {s["name"]: s["texture"] for shader in entry["shaders"].values() for s in shader["samplers"]}


def constants_of(entry):
    names = set()
    for shader in entry["shaders"].values():
        for block in shader["blocks"]:
            names |= {m["name"] for m in block["members"]} | {f"{block['name']}.{m['name']}" for m in block["members"]}
    return names


def format_of(texture):
    return texture["format"]["name"] if texture else None


def target_size(entry):
    target = next((t for t in [*entry["outputs"], entry["depth"]] if t), None)
    return [target["width"] >> target["mip"], target["height"] >> target["mip"]] if target else None


def place(entry):
    return f"pass {entry['index']} (event {entry['last_event']})"


def lacks(entry, rule, found):
    """(key, what the pass lacks, how many names are to blame) for each key of the rule that it does not meet."""
    have = samplers_of(entry)
    missing = [s for s in rule.get("samplers", []) if s not in have]
    if missing:
        yield "samplers", "has no sampler " + ", ".join(missing), len(missing)
    extra = [s for s in rule.get("not_samplers", []) if s in have]
    if extra:
        yield "not_samplers", "has the sampler " + ", ".join(extra), len(extra)
    flat = [s for s in rule.get("cube_samplers", []) if not (have.get(s) or {}).get("cube")]
    if flat:
        yield "cube_samplers", "has no cube map " + ", ".join(flat), len(flat)
    formats = [format_of(o) for o in entry["outputs"]]
    wanted = rule.get("outputs", [])
    if len(formats) < len(wanted) or any(w is not None and w != f for w, f in zip(wanted, formats)):
        yield "outputs", f"writes {', '.join(map(str, formats)) or 'nothing'}", 1
    names = [n for shader in entry["shaders"].values() for n in shader["outputs"]]
    missing = [n for n in rule.get("output_names", []) if n not in names]
    if missing:
        yield "output_names", "has no output " + ", ".join(missing), len(missing)
    known = constants_of(entry)
    missing = [c for c in rule.get("constants", []) if c not in known]
    if missing:
        yield "constants", "has no constant " + ", ".join(missing), len(missing)
    if "depth" in rule and format_of(entry["depth"]) != rule["depth"]:
        yield "depth", f"has the depth target {format_of(entry['depth'])}", 1
    if "size" in rule and target_size(entry) != rule["size"]:
        size = target_size(entry)
        yield "size", f"draws to {size[0]} x {size[1]}" if size else "has no target", 1
    if "kind" in rule and entry["kind"] != rule["kind"]:
        yield "kind", f"is a {entry['kind']}", 1
    if entry["draws"] < rule.get("draws_at_least", 0):
        yield "draws_at_least", f"has {entry['draws']} draws", 1
    if "reads_output_of" in rule:
        outputs = {o["id"] for o in found[rule["reads_output_of"]]["outputs"] if o}
        if not outputs & {t["id"] for t in have.values() if t}:
            yield "reads_output_of", f"reads no output of {rule['reads_output_of']}", 1


def find(passes, rule, found):
    """The pass that fits the rule; `found` holds the passes that were found before, by their names in the mapping."""
    unknown = sorted(set(rule) - KEYS)
    if unknown:
        raise FindError(unknown[0], f"is not a key of a pass{suggest(unknown[0], KEYS)}")
    before = rule.get("reads_output_of")
    if before is not None and before not in found:
        raise FindError("reads_output_of", f"expected a pass that is listed above, found {before}{suggest(before, found)}")
    fitting = [p for p in passes if not any(True for _ in lacks(p, rule, found))]
    pick = rule.get("pick", "only")
    if not fitting:
        nearest = min(passes, key=lambda p: sum(names for _, _, names in lacks(p, rule, found)), default=None)
        if nearest is None:
            raise FindError("", "the frame has no passes")
        key, why, _ = next(lacks(nearest, rule, found))
        wanted = ", ".join(map(str, rule[key])) if isinstance(rule[key], list) else rule[key]
        raise FindError(key, f"expected {wanted}, found in none of {len(passes)} passes; the nearest is {place(nearest)}, which {why}")
    if pick == "only":
        if len(fitting) > 1:
            raise FindError("pick", f"{len(fitting)} passes fit: {', '.join(place(p) for p in fitting[:6])}; say more of the pass, or pick first, last or a number from 0")
        return fitting[0]
    if pick in ("first", "last"):
        return fitting[0 if pick == "first" else -1]
    if not isinstance(pick, int) or isinstance(pick, bool) or not 0 <= pick < len(fitting):
        raise FindError("pick", f"expected only, first, last or a number from 0 to {len(fitting) - 1}, found {pick}")
    return fitting[pick]


def constant(entry, block, member):
    """Value of a constant as (rows, columns, numbers), or a FindError."""
    blocks = [(b, m) for shader in entry["shaders"].values() for b in shader["blocks"] for m in b["members"]]
    fitting = [m for b, m in blocks if m["name"] == member and block in (None, b["name"])]
    if not fitting:
        names = {b["name"] for b, _ in blocks}
        if block is not None and block not in names:
            raise FindError("block", f"{place(entry)} has no constant block {block!r}{suggest(block, names)}; it has {', '.join(sorted(map(repr, names))) or 'none'}")
        names = {m["name"] for _, m in blocks}
        raise FindError("member", f"{place(entry)} has no constant {member}{suggest(member, names)}; it has {', '.join(sorted(names)[:20]) or 'none'}")
    return fitting[0]
