""".ci/run beside a ./dev that only says what it was asked for, and the count that it ends with. Speaks TAP."""
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "viewer-cli"))
import tap  # noqa: E402


def run(demo, test, readme=None):
    """The exit status, the arguments of ./dev, and the last line; `demo` and `test` are shell code for these commands."""
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(os.path.join(folder, ".ci"))
        shutil.copy(os.path.join(HERE, "../.ci/run"), os.path.join(folder, ".ci"))
        if readme is None:
            shutil.copy(os.path.join(HERE, "../README.md"), folder)
        else:
            with open(os.path.join(folder, "README.md"), "w", encoding="utf-8") as file:
                file.write(readme)
        with open(os.path.join(folder, "dev"), "w", encoding="utf-8") as file:
            file.write(f'#!/bin/sh\necho "$*" >>asked\ncase "$*" in demo) {demo} ;; test) {test} ;; esac\n')
        os.chmod(os.path.join(folder, "dev"), 0o755)
        done = subprocess.run([os.path.join(folder, ".ci/run")], text=True, capture_output=True)
        with open(os.path.join(folder, "asked"), "a+", encoding="utf-8") as file:
            file.seek(0)
            return done.returncode, file.read().split("\n")[:-1], done.stdout.split("\n")[-2]


class Tests:
    def test_runs_the_commands_of_the_readme_in_their_order(self):
        assert run("echo pictures", "echo 12 passed, 0 failed, 1 skipped") == (0, ["demo", "test"], "12 passed, 0 failed, 1 skipped")
        report = "text\n\n    ./dev test     # this\n    ./dev demo && ./dev test\n\ntext\n\n    ./dev install\n"
        assert run("echo pictures", "echo 3 passed, 0 failed", report)[:2] == (0, ["test", "demo", "test"])

    def test_stops_at_the_first_failure(self):
        assert run("exit 3", "echo 12 passed, 0 failed") == (1, ["demo"], "0 passed, 1 failed")
        assert run("echo pictures", "echo 9 passed, 3 failed; exit 1") == (1, ["demo", "test"], "9 passed, 3 failed")

    def test_always_ends_with_the_count(self):
        assert run("echo pictures", "echo cannot build; exit 1") == (1, ["demo", "test"], "0 passed, 1 failed")
        assert run("echo pictures", "echo nothing counted") == (1, ["demo", "test"], "0 passed, 1 failed")
        assert run(":", ":", "no commands\n") == (1, [], "0 passed, 1 failed")


    def test_style_is_checked_without_git(self):
        with tempfile.TemporaryDirectory() as folder:
            tree = os.path.join(folder, "tree")
            shutil.copytree(os.path.dirname(HERE), tree, ignore=shutil.ignore_patterns(".git", "build*", "out", "docs", "records", "scenes"))
            with open(os.path.join(tree, "viewer-cli/main.c"), "a", encoding="utf-8") as file:
                file.write("int   spaced;\n")
            done = subprocess.run([sys.executable, "tests/check_style.py", "viewer-cli/main.c"], cwd=tree, text=True, capture_output=True)
        assert done.returncode == 1 and "main.c" in done.stderr and "clang-format" in done.stderr, done

    def test_a_program_that_gives_up_is_one_failure(self):
        """Meson lists it as a case of the same name; and the line gives the reason."""
        with tempfile.TemporaryDirectory() as folder:
            os.makedirs(os.path.join(folder, "build/meson-logs"))
            for name, text in (("junit.xml", '<testsuites><testsuite><testcase name="s / a" classname="s"><error/><system-out>Bail out! no b</system-out>'
                                '</testcase></testsuite></testsuites>'), ("json", '{"name": "s / a", "result": "ERROR", "returncode": 1}\n')):
                with open(os.path.join(folder, "build/meson-logs/testlog." + name), "w", encoding="utf-8") as file:
                    file.write(text)
            with open(os.path.join(folder, "build/style-ok"), "w", encoding="utf-8"):
                pass
            done = subprocess.run([sys.executable, os.path.join(HERE, "count_results.py"), "build"], cwd=folder, text=True, capture_output=True)
        assert done.returncode == 1 and done.stdout == "failed: build: s s / a: no b\n1 passed, 1 failed\n", done.stdout


sys.exit(tap.run(Tests()))
