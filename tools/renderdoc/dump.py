#!/usr/bin/python3
"""Writes the manifest and the textures of `glint pack` from a frame that RenderDoc captured, as a mapping says.

  dump.py FRAME_1.rdc MAPPING.json -o DIR --previous FRAME_0.rdc
  glint pack DIR/manifest.json -o frame.exr

A mapping is a JSON file of data (mapping.schema.json completes it in an editor; supertuxkart.json is one):

  passes     names for passes, each found by what its shader reads and writes:
               "combine": {"samplers": ["diffuse_map", "ssao_tex"], "pick": "last"}
             samplers, not_samplers, cube_samplers, outputs (formats), output_names, constants, depth (format), size, kind, draws_at_least,
             reads_output_of (a pass above); pick is only (the default: another one that fits is an error), first, last or a number
  images     what a pass reads or writes, as it is after the pass's last draw (targets are used again later in the frame):
               "normal": {"pass": "combine", "sampler": "normal_color"}, "color": {"pass": "combine", "output": 0},
               "zs": {"pass": "geometry", "depth": true}; also mip, layer, rows
  constants  numbers, vectors and matrices: "view": {"pass": "combine", "block": "Matrices", "member": "u_view_matrix"}
  values     expressions by names of their own, for the ones below
  textures   files for the manifest: {"image": "zs"} as it lies in memory, or {"expression": "diffuse.rgb * albedo.rgb"} as floats;
             with "frame": "previous" that of the other capture
  manifest   frame and parts of the manifest, as docs/pack.md has them; {"expression": "inverse(view)"} stands for numbers

What needs the previous frame is left out, and said, where there is no --previous. An expression has numbers, names, components
(.rgb, .x, matrix[0, 2]), + - * / ** @, comparisons, and, or, not, previous.NAME, and these functions:

FUNCTIONS
"""
import argparse
import os
import sys

import expressions
import list_passes
import mapping
import rdc
import texels


class Source:
    """A frame for mapping.py: its list of passes, and its capture, which is opened when the first image is read."""

    def __init__(self, path, passes, module):
        self.path, self.module, self.open = path, module, None
        listed = list_passes.list_of(passes or path, module, lambda text: print(text, file=sys.stderr))
        self.passes, self.api = listed["passes"], listed["api"]

    def read(self, event, texture, mip, layer):
        if self.open is None:
            self.open = rdc.Capture(self.path, self.module)
        return self.open.read(event, texture, mip, layer)

    def close(self):
        if self.open is not None:
            self.open.close()
            self.open = None


def help_text():
    lines = [f"  {name:14} {meaning}" for name, (_, _, _, meaning) in sorted(expressions.FUNCTIONS.items())]
    return __doc__.replace("FUNCTIONS\n", "\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=help_text(), formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("capture", help="the frame, a .rdc of RenderDoc")
    parser.add_argument("mapping", help="how to read it, JSON")
    parser.add_argument("-o", dest="folder", required=True, help="folder for manifest.json and the textures")
    parser.add_argument("--previous", help="the frame before it, captured in the same run")
    parser.add_argument("--passes", help="list of the frame's passes, if list_passes.py --json wrote it before")
    parser.add_argument("--previous-passes", help="the same of the previous frame")
    parser.add_argument("--module", help="folder of renderdoc.so, where Python does not find it by itself")
    arguments = parser.parse_args()
    sources = []
    try:
        rules = mapping.load(arguments.mapping)
        sources.append(Source(arguments.capture, arguments.passes, arguments.module))
        if arguments.previous:
            sources.append(Source(arguments.previous, arguments.previous_passes, arguments.module))
        path = mapping.apply(rules, sources[0], arguments.folder, sources[1] if arguments.previous else None, print)
    except mapping.MappingError as error:
        sys.exit(f"{os.path.basename(arguments.mapping)}: {error}")
    except (rdc.CaptureError, texels.FormatError, OSError, ValueError) as error:
        sys.exit(f"dump.py: {error}")
    finally:
        for source in sources:
            source.close()
    print(f"{path}; now: glint pack {path} -o FRAME.exr")


if __name__ == "__main__":
    main()
