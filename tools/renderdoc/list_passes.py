#!/usr/bin/python3
"""Lists the passes of a frame that RenderDoc captured: what they write, what their shaders read, and their constants.

  list_passes.py CAPTURE.rdc                      a table, to read
  list_passes.py CAPTURE.rdc --json -o FRAME.json the same as JSON, which dump.py takes with --passes
  list_passes.py FRAME.json --only combine        the table of passes whose samplers, outputs or constants have this in their names

A pass is a run of draws into the same targets; a draw that may cover the screen stands alone. Its shaders are those of its last draw.
The list is what a mapping is written from: see docs/engines/renderdoc.md.

RenderDoc replays the frame once a pass, so this takes a second or two a pass on a software driver. It needs a DISPLAY; Xvfb's is enough.
"""
import argparse
import json
import sys

import find
import rdc


def describe_texture(texture):
    if texture is None:
        return "nothing"
    size = f"{texture['width']} x {texture['height']}"
    extra = [f"level {texture['mip']}"] if texture.get("mip") else []
    extra += ["cube map"] if texture["cube"] else [f"{texture['layers']} layers"] if texture["layers"] > 1 else []
    extra += [f"{texture['mips']} levels"] if texture["mips"] > 1 else []
    return f"{texture['id']}: {texture['format']['name']}, {size}" + "".join(", " + e for e in extra)


def describe_member(member):
    numbers = ", ".join(f"{v:.6g}" for v in member["value"][:16])
    shape = f"{member['rows']} x {member['columns']}, by rows" if member["rows"] > 1 else member["columns"]
    return f"{member['name']} ({member['type']}, {shape}): {numbers}"


def print_pass(entry, out, constants=True):
    events = f"{entry['first_event']} to {entry['last_event']}" if entry["draws"] > 1 else str(entry["last_event"])
    print(f"pass {entry['index']}: {entry['kind']}, event {events}, {entry['draws']} draw{'s' if entry['draws'] > 1 else ''}, {entry['vertices']} vertices", file=out)
    for i, texture in enumerate(entry["outputs"]):
        print(f"  output {i}: {describe_texture(texture)}", file=out)
    if entry["depth"]:
        print(f"  depth: {describe_texture(entry['depth'])}", file=out)
    for stage, shader in entry["shaders"].items():
        if shader["outputs"] and stage == "fragment":
            print(f"  {stage} writes {', '.join(shader['outputs'])}", file=out)
        for sampler in shader["samplers"]:
            print(f"  {stage} {'sampler' if sampler['access'] == 'sampled' else 'storage image'} {sampler['name']}: {describe_texture(sampler['texture'])}", file=out)
        for block in shader["blocks"] if constants else []:
            print(f"  {stage} block {block['name']!r}", file=out)
            for member in block["members"]:
                print(f"    {describe_member(member)}", file=out)


def mentions(entry, text):
    names = [n for s in entry["shaders"].values() for n in s["outputs"]]
    return any(text in n for n in [*find.samplers_of(entry), *find.constants_of(entry), *names])


def list_of(path, module=None, say=lambda text: None):
    """The list of an .rdc, or one that was written before."""
    if path.endswith(".json"):
        with open(path, encoding="utf-8") as text:
            return json.load(text)
    with rdc.Capture(path, module) as capture:
        return {"glint_passes": 1, "capture": path, "api": capture.api,
                "passes": capture.passes(lambda p: say(f"{find.place(p)}: {', '.join(find.samplers_of(p)) or 'no samplers'}"))}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("capture", help="a .rdc of RenderDoc, or a list that this program wrote as JSON")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("-o", dest="output", help="write to this file")
    parser.add_argument("--only", help="passes in whose names this text stands")
    parser.add_argument("--no-constants", action="store_true", help="leave constants out of the table")
    parser.add_argument("--module", help="folder of renderdoc.so, where Python does not find it by itself")
    arguments = parser.parse_args()
    try:
        found = list_of(arguments.capture, arguments.module, lambda text: print(text, file=sys.stderr))
    except (rdc.CaptureError, OSError, ValueError) as error:
        sys.exit(f"list_passes.py: {error}")
    if arguments.only:
        found["passes"] = [p for p in found["passes"] if mentions(p, arguments.only)]
    with open(arguments.output, "w", encoding="utf-8") if arguments.output else sys.stdout as out:
        if arguments.json:
            json.dump(found, out, indent=1)
            print(file=out)
        else:
            print(f"{found['capture']}: {found['api']}, {len(found['passes'])} passes", file=out)
            for entry in found["passes"]:
                print_pass(entry, out, not arguments.no_constants)


if __name__ == "__main__":
    main()
