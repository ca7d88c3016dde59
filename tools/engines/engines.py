"""Frames of real engines, from their start to glint's replay. Run by ./dev engines.

Finished steps stay in FOLDER and are not repeated; delete a step's result to do it again. Data of games and captures are only there."""
import argparse
import pathlib
import time

import babylon
import blender
import games

# Each has prove(glint, folder), which does all steps, and pictures(glint, folder, docs), which writes the pictures of its page.
ENGINES = {"renderdoc": games, "babylon": babylon, "blender": blender}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glint", metavar="GLINT", type=lambda p: pathlib.Path(p).resolve(), help="the program")
    parser.add_argument("folder", metavar="FOLDER", type=lambda p: pathlib.Path(p).resolve(), help="for captures, logs and runs")
    parser.add_argument("engines", metavar="ENGINE", nargs="*", choices=[[], *ENGINES], help=f"of {', '.join(ENGINES)}; all where none is named")
    parser.add_argument("--pictures", metavar="DOCS", type=pathlib.Path, help="write the pictures of docs/engines to this folder")
    arguments = parser.parse_args()
    for name in arguments.engines or ENGINES:
        start = time.monotonic()
        ENGINES[name].prove(arguments.glint, arguments.folder)
        print(f"{name}: {time.monotonic() - start:.0f} s, without what was done before", flush=True)
        if arguments.pictures:
            ENGINES[name].pictures(arguments.glint, arguments.folder, arguments.pictures.resolve())
    print(f"captures, logs, times.json and runs: {arguments.folder}")


if __name__ == "__main__":
    main()
