"""Runs docs/writing-a-pass.md as it is printed, in a copy of the tree: writing_a_pass.py. Speaks TAP.

A fenced block is the file whose name stands alone above it; a command is indented by four spaces. What the page says that the commands find is
asserted here: the new pass is in the handbook, its off switch changes no bit, and the comparison has both presets."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.append(os.path.join(ROOT, "tests/viewer-cli"))
import tap  # noqa: E402

STEP = re.compile(r"^`(?P<file>[\w./]+)`\n\n```\w+\n(?P<text>(?:.*\n)*?)```$|^    (?P<command>\S.*)$", re.M)


def steps():
    """The files and commands of the page, in order: (file, text) or (None, command)."""
    with open(os.path.join(ROOT, "docs/writing-a-pass.md"), encoding="utf-8") as page:
        text = page.read()
    # Code inside of a fenced block is not a command: the expression matches the whole block first.
    return [(m["file"], m["text"]) if m["file"] else (None, m["command"]) for m in STEP.finditer(text)]


def copied(folder):
    """The tree without build results, and without large files that the build does not need."""
    tree = os.path.join(folder, "glint")
    shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns("build*", ".git", "out", "bundle", "__pycache__", "*.jpg", "*.png"))
    return tree


class Tests:
    def __init__(self, folder):
        self.tree, self.printed = copied(folder), {}

    def run(self, command):
        environment = {**os.environ, "GLINT_CACHE": "none"}
        done = subprocess.run(command, shell=True, cwd=self.tree, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, (command, done.returncode, done.stdout[-2000:], done.stderr[-2000:])
        self.printed[command] = done.stdout

    def test_the_page_runs_as_printed(self):
        page = steps()
        assert sum(file is not None for file, _ in page) == 2 and len(page) > 15, page
        for file, text in page:
            if file is None:
                self.run(text)
                continue
            path = os.path.join(self.tree, file)
            assert not os.path.exists(path), f"{file} exists already: the page no longer starts from nothing"
            with open(path, "w", encoding="utf-8") as written:
                written.write(text)
        handbook = self.printed["build/viewer-cli/glint passes blur/box"]
        assert "Box filter on one surface" in handbook and "radius" in handbook and "depth_part" in handbook, handbook
        with open(os.path.join(self.tree, "docs/passes.md"), encoding="utf-8") as made:
            assert "#### `blur/box`" in made.read()
        with open(os.path.join(self.tree, "compared/index.html"), encoding="utf-8") as compared:
            text = compared.read()
            assert "mafia3" in text and "box" in text

    def test_what_the_blur_does(self):
        """The page's check of the off switch would pass for a shader that only copies."""
        glint = "build/viewer-cli/glint"
        self.run(f"{glint} replay street.exr -o wide --use blur=box --set blur.radius=4")
        run = subprocess.run(f"{glint} diff wide/*-compose.exr off/*-compose.exr", shell=True, cwd=self.tree, capture_output=True, text=True)
        assert run.returncode == 2, (run.returncode, run.stdout, run.stderr)


with tempfile.TemporaryDirectory() as scratch:
    sys.exit(tap.run(Tests(scratch)))
