"""glint live where things go wrong: a lost device, files that were removed, command lines with odd words.

live_faults.py GLINT FOLDER: that of the manifest of the layer whose calls fail. Speaks TAP."""
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

import tap
from live import Live, Refused

GLINT, LAYER = sys.argv[1:]
SHADER = str(pathlib.Path(__file__).resolve().parents[2] / "passes/reflection/blur/plus.comp")


class Tests:
    def __init__(self, folder):
        self.folder = folder
        self.capture = folder / "street.exr"
        tap.glint("sample", "street", "--light=1", "-o", str(folder / "shot.exr"), "--size", "64x36", "--cube-size", "16", "--frames", "2", "--cut")
        tap.glint("sample", "street", "--light=1", "-o", str(self.capture), "--size", "64x36", "--cube-size", "16")
        self.lost = folder / "lost"  # while it exists, the layer loses devices
        self.fault = {**os.environ, "VK_LAYER_PATH": LAYER, "VK_INSTANCE_LAYERS": "VK_LAYER_GLINT_fault", "GLINT_FAULT_STAY": "libvulkan_lvp.so", "GLINT_FAULT_FILE": str(self.lost)}

    def loses(self, ask):
        """The request finds the device lost."""
        self.lost.touch()
        try:
            ask()
        except Refused as refusal:
            assert (refusal.status, refusal.code) == (500, "device") and "lost" in refusal.message, refusal
        else:
            raise AssertionError("the device was not lost")
        finally:
            self.lost.unlink()

    def test_a_lost_device_is_opened_again(self):
        """Whichever job finds it lost: the next one has another. Here a job finds it when it reads images back, as nothing has to run."""
        with Live(GLINT, self.capture, "-o", self.folder / "again", env=self.fault) as other:
            run = other.post("run", state={})
            for ask in (lambda: other.get(f"picture?run={run['run']}&image={run['picture']}"), lambda: other.post("write", state={}, name="run"),
                        lambda: other.post("report", a={}, b={})):
                other.post("run", state={})
                self.loses(ask)
                assert ask()

    def test_a_run_that_was_not_written_leaves_its_name(self):
        shot = sorted(p for p in self.folder.glob("shot.*.exr") if "cubemaps" not in p.name)
        with Live(GLINT, *shot, "-o", self.folder / "shots", env=self.fault) as other:
            other.post("run", state={"capture": 1})
            self.loses(lambda: other.post("write", state={"capture": 1}, name="x"))
            assert not (self.folder / "shots/x").exists()
            other.post("write", state={"capture": 1}, name="x")
            assert (self.folder / "shots/x" / shot[1].stem / "run.json").exists()

    def test_a_draft_that_was_removed_is_made_again(self):
        folder = self.folder / "temporary"
        folder.mkdir()
        with Live(GLINT, self.capture, env={**os.environ, "TMPDIR": str(folder)}) as other:
            first = other.post("run", state={}, draft=True)
            files = list(folder.glob("*/draft*"))
            assert files, list(folder.rglob("*"))
            for file in files:
                file.unlink()
            other.post("run", state={})
            assert other.post("run", state={}, draft=True)["run"] == first["run"]

    def test_the_command_line_says_what_the_state_says(self):
        with Live(GLINT, self.capture) as live:
            for number in (3, 3.0, "3", "3.0"):
                answer = live.post("pipeline", state={"set": {"pipeline.first_ray": number}})
                assert answer["state"]["set"] == {"pipeline.first_ray": 3} and answer["command"].endswith("--set pipeline.first_ray=3"), answer
        dash = self.folder / "-dash.exr"
        dash.symlink_to(self.capture)
        with Live(GLINT, "--set", "pipeline.first_ray=3", "--shader", f"blur={SHADER}", "--", "-dash.exr", cwd=self.folder) as other:
            start = other.get("registry")["start"]
            assert start["set"] == {"pipeline.first_ray": 3}, start
            for use, shown in (({}, True), ({"blur": "none"}, False)):
                command = other.post("pipeline", state={**start, "use": use})["command"]
                assert (f"--shader blur={SHADER}" in command) == shown, command
                words = shlex.split(command.replace(" -o run ", f" -o dash-{shown} "))[1:]
                subprocess.run([GLINT, *words], check=True, cwd=self.folder, capture_output=True)
        for words, said in ((["--set", "blur.depth_part=nan"], "depth_part: expected"), (["--set", "blur.depth_part=1e999"], "depth_part: expected"),
                            (["--shader", f"blurr={SHADER}"], "did you mean blur"), (["-o", b"\xe9"], "UTF-8"), (["--use", "blur"], "'blur'")):
            done = subprocess.run([GLINT, "live", self.capture, *words], capture_output=True, timeout=60)
            assert done.returncode == 2 and said.encode() in b" ".join(done.stderr.split()) and not done.stdout, (words, done)


with tempfile.TemporaryDirectory(prefix="glint-live-faults-") as work:
    sys.exit(tap.run(Tests(pathlib.Path(work))))
