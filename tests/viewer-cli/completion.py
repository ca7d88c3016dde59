"""Completion in the real shells, at a terminal: words are typed up to the tab key, and the shell runs what then stands there: completion.py
GLINT FOLDER_OF_SCRIPTS. Speaks TAP."""
import json
import os
import pty
import re
import select
import signal
import subprocess
import sys
import tempfile
import time

import tap
from tap import programs

GLINT, SCRIPTS = sys.argv[1:]

# What is typed after glint, and the last argument that results.
CASES = [
    ("repl", "replay"),
    ("help selft", "selftest"),
    ("replay --prese", "--preset="),
    ("replay s.exr --preset=mafia_de_t", "--preset=mafia_de_taa"),
    ("replay s.exr -p kf", "kf2"),
    ("replay s.exr -p min", "mine"),
    ("replay s.exr -p ./my.", "./my.json"),
    ("compare s.exr --presets mafia3,gt", "mafia3,gtav"),
    ("replay s.exr --set screen_tr", "screen_trace."),
    ("replay s.exr --set screen_trace.thickn", "screen_trace.thickness"),
    ("replay s.exr --set=downsample.jitter=fal", "--set=downsample.jitter=false"),
    ("replay s.exr --use=screen_trace=dd", "--use=screen_trace=dda"),
    ("replay s.exr --shader resolve=my_s", "resolve=my_shader.comp"),
    ("replay s.exr --precision hal", "half"),
    ("replay s.exr --inputs=ru", "--inputs=run"),
    ("live s.exr --token-f", "--token-file="),
    ("live s.exr --use=screen_trace=dd", "--use=screen_trace=dda"),
    ("batch resub", "resubmit"),
    ("batch vali", "validate"),
    ("batch sweep s.exr --vary screen_tr", "screen_trace."),
    ("sample deser", "desert_night"),
    ("sample room --normal=octa", "--normal=octahedral"),
    ("passes screen_trace/hi", "screen_trace/hiz"),
    ("view run --image=an_im", "--image=an_image"),
    ("view run:oth", "run:other"),
    ("view s.exr:gbu", "s.exr:gbuffer"),
    ("view s.exr --part li", "lit"),
    ("export run --images other,an", "other,an_image"),
    ("diff run run --metrics rmse,ssi", "rmse,ssim"),
    ("strip s.exr --keep gbuffer:stenc", "gbuffer:stencil.id"),
    ("set s.exr metresP", "metresPerUnit="),
    ("set s.exr clipZ=min", "clipZ=minus_one_to_one"),
    ("info two", "two words.exr"),
]

SHELLS = {
    "bash": (["--norc", "--noprofile", "-i"], "source {scripts}/glint.bash; glint() {{ printf '%s\\n' \"$@\" >said.tmp; mv said.tmp said; }}"),
    "zsh": (["-f", "-i"], "fpath=({scripts} $fpath); autoload -U compinit; compinit -u -D; "
                          "glint() {{ printf '%s\\n' \"$@\" >said.tmp; mv said.tmp said }}"),
    "fish": (["--no-config", "-i"], "set -g fish_autosuggestion_enabled 0; source {scripts}/glint.fish; "
                                    "function glint; printf '%s\\n' $argv >said.tmp; mv said.tmp said; end"),
}


class Terminal:
    """A shell at a pseudo-terminal of its own."""

    def __init__(self, shell):
        options, start = SHELLS[shell]
        path = programs.find(shell)
        environment = {"HOME": os.getcwd(), "TERM": "dumb", "LANG": "C.UTF-8", "GLINT_PRESETS": "presets",
                       "PATH": f"{os.path.dirname(GLINT)}:/usr/bin:/bin", "PS1": "$ "}
        self.pid, self.fd = pty.fork()
        if self.pid == 0:
            os.execve(path, [shell, *options], environment)
        self.shown = b""
        self.type(start.format(scripts=SCRIPTS) + "; touch ready\r")
        self.wait("ready")

    def type(self, text):
        os.write(self.fd, text.encode())

    def wait(self, name, seconds=60):
        """Reads what the shell shows until the file is there."""
        end = time.monotonic() + seconds
        while not os.path.exists(name):
            if time.monotonic() > end:
                raise AssertionError(f"no {name} after {seconds} s; the terminal shows {self.shown[-2000:]!r}")
            if select.select([self.fd], [], [], 0.05)[0]:
                self.shown += os.read(self.fd, 65536)
        with open(name, encoding="utf-8") as file:
            text = file.read()
        os.unlink(name)
        return text

    def completed(self, words):
        self.type(f"glint {words}\t")
        self.type("\r")
        return self.wait("said").splitlines()

    def close(self):
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
        os.close(self.fd)


class Tests:
    def __init__(self, folder):
        os.chdir(folder)
        subprocess.run([GLINT, "sample", "room", "--light=4", "--size", "16x9", "--cube-size", "8", "-o", "s.exr"], check=True, capture_output=True)
        os.link("s.exr", "two words.exr")
        os.makedirs("run")
        images = [{"name": name, "file": "01-a.exr", "part": name, "channels": "Z", "unit": "m", "meaning": "for this test", "width": 4,
                   "height": 4, "format": "R32F"} for name in ("an_image", "other")]
        with open("run/run.json", "w", encoding="utf-8") as file:
            json.dump({"format": 1, "passes": [{"slot": "none", "variant": "none", "images": images}]}, file)
        os.makedirs("presets")
        for name in ("presets/mine.json", "my.json", "my_shader.comp"):
            with open(name, "w", encoding="utf-8") as file:
                file.write("{}\n")

    def check(self, shell):
        terminal = Terminal(shell)
        try:
            wrong = []
            for typed, last in CASES:
                found = terminal.completed(typed)[-1]
                if found.removesuffix("/") != last:  # of a folder; zsh takes it away again
                    wrong.append((typed, last, found))
            assert not wrong, wrong
        finally:
            terminal.close()

    def test_bash(self):
        self.check("bash")

    def test_zsh(self):
        self.check("zsh")

    def test_fish(self):
        self.check("fish")

    def candidates(self, *words):
        done = subprocess.run([GLINT, "--complete", *words], capture_output=True, text=True, check=True)
        assert not done.stderr, done.stderr
        return dict(line.split("\t") for line in done.stdout.splitlines())

    def test_every_option_of_the_help_is_offered(self):
        commands = self.candidates("")
        assert len(commands) > 20 and commands["replay"], commands
        for command in sorted(set(commands) - {"help"}):
            words = subprocess.run([GLINT, command, "--help"], capture_output=True, text=True, check=True).stdout.split("Examples:")[0]
            options = set(re.findall(r"^  (?:-., |    )(--[a-z0-9-]+)", words, re.M))
            offered = {name.rstrip("=") for name in self.candidates(command, "--")}
            assert options - offered <= {"--usage", "--version"}, (command, options - offered)
            assert len(offered) > 1 and all(text for name, text in self.candidates(command, "--").items()), command

    def test_descriptions_are_single_lines(self):
        for words in ([""], ["replay", "--"], ["replay", "--set", "screen_trace."], ["view", "--image", ""], ["set", "s.exr", ""]):
            for name, about in self.candidates(*words).items():
                assert name and len(about) < 300 and about.isprintable(), (name, about)

    def test_values_of_parameters_say_what_they_may_be(self):
        numbers = self.candidates("replay", "--set", "screen_trace.cells=")
        assert numbers, numbers
        for number, about in numbers.items():
            assert re.fullmatch(r"screen_trace.cells=\d+", number) and re.fullmatch(r"default of \w+, \d+ to \d+", about), (number, about)
        assert set(self.candidates("replay", "--set", "downsample.jitter=")) == {"downsample.jitter=true", "downsample.jitter=false"}
        assert "pipeline.fog=" in self.candidates("replay", "--set", "pipeline.")

    def test_nonsense_offers_nothing(self):
        for words in ([], ["nothing", ""], ["replay", "--bogus="], ["replay", "--set", "no.such="], ["view", "nowhere:x"[:8] + ":y"], ["x" * 9000],
                      ["replay", "--set=" + "y" * 9000 + "."], ["set", "s.exr", "=" * 5000]):
            found = self.candidates(*words)
            assert not found or set(found) <= {":files", ":folders"}, (words, found)


with tempfile.TemporaryDirectory() as temporary:
    status = tap.run(Tests(temporary))
sys.exit(status)
