"""Tests whose programs, device or validation layer are missing fail and name the Debian package: missing.py BUILD. Speaks TAP."""
import json
import os
import shlex
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "viewer-cli"))
import tap  # noqa: E402
from tap import programs  # noqa: E402

BUILD = sys.argv[1]
# One test for each way in which tests run other programs, and its case that does.
WITHOUT = {"mandoc": ("cli_help", "man_pages_have_no_lint"), "idiff": ("cli_diff", "verdicts_are_idiffs"), "oiiotool": ("cli_view_more", "longitude_and_latitude_*"),
           "exrheader": ("foreign_tools", "*"), "exrinfo": ("gpu_run_files", "foreign_tools_*"), "chromium-headless-shell": ("cli_page", "*")}


def path_without(folder, *names):
    """All programs on this machine except these."""
    for place in os.environ["PATH"].split(":"):
        for name in os.listdir(place) if os.path.isdir(place) else ():
            link = os.path.join(folder, name)
            if name not in names and not os.path.lexists(link):
                os.symlink(os.path.join(place, name), link)
    return folder


class Tests:
    def __init__(self):
        with open(os.path.join(BUILD, "meson-info/intro-tests.json"), encoding="utf-8") as file:
            self.tests = {test["name"]: test for test in json.load(file)}

    def says(self, name, **environment):
        """The exit status and all output of a test in this environment."""
        words = self.tests[name]["cmd"]
        if words[1:] and words[1].endswith(".py"):
            words = [sys.executable, *words[1:]]  # whichever program is python3 on the PATH
        done = subprocess.run(words, env={**os.environ, **self.tests[name]["env"], **environment}, cwd=BUILD, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return done.returncode, done.stdout

    def test_no_command_holds_what_configuring_found(self):
        for name, test in self.tests.items():
            for word in test["cmd"]:
                assert word and os.path.basename(word) not in programs.PACKAGES, (name, test["cmd"])

    def test_a_program_that_is_missing_is_named(self):
        for program, (name, case) in WITHOUT.items():
            with tempfile.TemporaryDirectory() as folder:
                status, said = self.says(name, PATH=path_without(folder, program, "chromium"), GLINT_TEST_ONLY=case)
            assert status and f"{program} is not installed: apt-get install {programs.PACKAGES[program]}," in said, (name, status, said)

    def test_a_missing_validation_layer_is_a_failure(self):
        for name in ("gpu_keep", "gpu_classify"):
            status, said = self.says(name, VK_LAYER_PATH="/nowhere")
            assert status and "vulkan-validationlayers" in said and "# SKIP" not in said, (name, status, said)

    def test_a_missing_device_is_a_failure_where_one_is_required(self):
        for required in ("0", "1"):
            status, said = self.says("gpu_keep", VK_DRIVER_FILES="/nowhere", VK_ICD_FILENAMES="/nowhere", GLINT_REQUIRE_DEVICE=required)
            assert (status != 0) == (required == "1") and "mesa-vulkan-drivers" in said and ("# SKIP" in said) == (required == "0"), (status, said)

    def test_dev_installs_what_tests_run(self):
        with open(os.path.join(HERE, "../dev"), encoding="utf-8") as file:
            lines = [line for line in file if line.startswith(("test_packages=", "long_packages="))]
        listed = subprocess.run(["sh", "-c", "".join(lines) + 'echo $test_packages $long_packages'], cwd=os.path.dirname(HERE), text=True, capture_output=True, check=True).stdout
        assert len(lines) == 2 and sorted(shlex.split(listed)) == sorted(set(programs.PACKAGES.values())), listed


sys.exit(tap.run(Tests()))
