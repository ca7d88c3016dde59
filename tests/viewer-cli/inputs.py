"""Bad input and early ends: damaged files, names that the format has not, no device, interruptions, full disks: inputs.py GLINT. Speaks TAP."""
import json
import os
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

import tap

GLINT = sys.argv[1]


def run(words, **more):
    return subprocess.run([GLINT, *words.split()], capture_output=True, text=True, encoding="utf-8", **more)


def ok(words, status=0):
    done = run(words)
    assert done.returncode == status, (words, done.returncode, done.stdout[-1000:], done.stderr)
    return done


def interrupted(words, when, **more):
    """Stops the command as soon as when() holds."""
    process = subprocess.Popen([GLINT, *words.split()], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)
    end = time.monotonic() + 100
    while not when() and process.poll() is None and time.monotonic() < end:
        time.sleep(0.02)
    assert process.poll() is None, (words, process.communicate())
    process.send_signal(signal.SIGINT)
    out, err = process.communicate()
    assert process.returncode == 130, (words, process.returncode, out, err)
    return err


class Tests:
    def __init__(self, folder):
        os.chdir(folder)
        ok("sample room --light 4 --size 48x27 --cube-size 8 --truth 1 -o s.exr")
        with open("s.exr", "rb") as file:
            self.bytes = file.read()

    def write(self, name, data):
        with open(name, "wb") as file:
            file.write(data)

    # ---- names of attributes ----

    def test_misspelt_attributes_are_named_and_can_be_removed(self):
        self.write("misspelt.exr", self.bytes.replace(b"glint.exposure\0", b"glint.exposurE\0").replace(b"glint.roughness\0", b"glint.roughnesS\0"))
        said = ok("validate misspelt.exr", 1).stdout
        assert "part gbuffer: glint.exposurE: expected an attribute of the format (did you mean glint.exposure?)  [attributes]" in said, said
        assert "part gbuffer: glint.roughnesS: expected an attribute of the format (did you mean glint.roughness?)  [attributes]" in said, said
        for command in ("info misspelt.exr", "replay misspelt.exr", "lint misspelt.exr"):
            assert "did you mean glint." in ok(command, 1).stderr, command
        ok("set misspelt.exr glint.exposurE= glint.roughnesS= exposure=1 roughness=perceptual -o mended.exr")
        assert ok("validate mended.exr").stdout == "mended.exr: valid\n"
        assert "no such key" in ok("set misspelt.exr glint.exposurE=2 -o no.exr", 2).stderr

    # ---- what is absent ----

    def test_only_what_costs_something_is_warned_of(self):
        """A probe takes the place of a sky or of cube maps; a capture that has these lacks nothing without one."""
        said = ok("replay s.exr -p kf2").stderr
        assert "probe" not in said and "fallback" not in said, said
        ok("strip s.exr --drop cubemap,sky -o bare.exr")
        said = ok("replay bare.exr").stderr
        assert "no cubemap: " in said and "no sky: " in said and "probe.000" not in said, said

    # ---- damaged files ----

    def test_headers_of_a_cut_file_are_listed(self):
        self.write("cut.exr", self.bytes[:len(self.bytes) * 2 // 3])
        done = ok("info --headers cut.exr", 1)
        assert "cut.exr: damaged" in done.stdout and "gbuffer" in done.stdout and "depth.Z" in done.stdout, done.stdout
        assert "breaks at: part " in done.stdout and f"which ends at byte {len(self.bytes) * 2 // 3}" in done.stdout, done.stdout
        assert "missing or damaged" in done.stderr, done.stderr
        found = json.loads(ok("info --headers --json cut.exr", 1).stdout)
        whole = json.loads(ok("info --headers --json s.exr").stdout)
        assert [p["name"] for p in found["parts"]] == [p["name"] for p in whole["parts"]]
        for ours, theirs in zip(found["parts"], whole["parts"]):
            if "sibling" not in theirs:
                assert (ours["width"], ours["height"]) == (theirs["width"], theirs["height"]), ours
                assert sorted(c["name"] for c in ours["channels"]) == sorted(c["name"] for c in theirs["channels"])
        assert sum(p["whole_chunks"] < p["chunks"] for p in found["parts"]) and found["parts"][0]["whole_chunks"] == found["parts"][0]["chunks"] > 0
        assert found["breaks_at"] and "missing or damaged" in found["fault"]
        assert "--headers lists what can be read" in ok("info cut.exr", 1).stderr

    def test_a_header_is_listed_up_to_where_it_breaks(self):
        at = self.bytes.index(b"glint.worldToView\0")
        self.write("header.exr", self.bytes[:at + 60])
        done = ok("info --headers header.exr", 1)
        assert "gbuffer (its header breaks)" in done.stdout and "48 × 27" in done.stdout, done.stdout
        assert f"header 1: attribute glint.worldToView at byte {at}: 128 bytes of m44d from byte {at + 27} on, but the file ends at byte {at + 60}" in done.stdout, done.stdout
        self.write("start.exr", self.bytes[:6])
        assert "the first 8 bytes are cut off" in ok("info --headers start.exr", 1).stdout
        self.write("text.exr", b"a text\n")
        assert "expected an EXR file, found other bytes" in ok("info --headers text.exr", 1).stderr

    def test_every_length_of_a_file_is_survived(self):
        for length in range(0, 4000, 97):
            self.write("some.exr", self.bytes[:length])
            done = run("info --headers some.exr --json")
            assert done.returncode == 1 and done.stderr, (length, done)
            if length > 8:
                json.loads(done.stdout)
        for length in range(200, 4000, 131):  # a huge size of an attribute, or of a string
            self.write("some.exr", self.bytes[:length] + b"\xff\xff\xff\x7f" + self.bytes[length + 4:])
            done = run("info --headers some.exr --json")
            assert done.returncode in (0, 1), (length, done)
            json.loads(done.stdout)

    def test_a_capture_that_breaks_rules_is_listed(self):
        self.write("lit.exr", self.bytes.replace(b"name\0string\0\3\0\0\0lit", b"name\0string\0\3\0\0\0lid", 1))
        done = ok("info --headers lit.exr", 1)
        assert "lit.exr: not a valid capture" in done.stdout and "depth.Z" in done.stdout and "lid" in done.stdout, done.stdout
        assert "lit: missing" in done.stderr and "glint validate" in done.stderr, done.stderr

    # ---- no device ----

    def test_a_selftest_without_a_device_is_none_that_failed(self):
        none = dict(os.environ, VK_ICD_FILENAMES="/none", VK_DRIVER_FILES="/none")
        done = run("selftest --quick", env=none)
        assert done.returncode == 2 and "no Vulkan driver" in done.stderr, (done.returncode, done.stderr)
        assert run("replay s.exr", env=none).returncode == 1

    # ---- interruptions ----

    def test_a_reference_says_what_it_kept(self):
        said = interrupted("reference s.exr -o ref --rays 4096", lambda: os.path.exists("ref/unfinished.exr") or os.path.exists("ref/run.json"))
        assert "rays per pixel are kept in ref; the same command resumes" in said and "lost" not in said, said
        kept = int(said.split(" rays per pixel are kept")[0].split()[-1])
        resumed = run("reference s.exr -o ref --rays 16 --progress")
        assert resumed.returncode == 0 and (kept >= 16 or f"{kept} of 16 rays" in resumed.stderr), (kept, resumed.stderr)

    def test_a_reference_that_cannot_be_written_is_not_kept(self):
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (900, 900))  # noqa: E731
        start = time.monotonic()
        said = interrupted("reference s.exr -o lost --rays 4096", lambda: time.monotonic() > start + 4, preexec_fn=limit, restore_signals=False)
        assert "kept in lost" not in said and ("are lost: they could not be written to lost" in said or "nothing is kept" in said), said
        assert not os.path.exists("lost/run.json") and not os.path.exists("lost/unfinished.exr")

    def test_studies_say_what_they_kept(self):
        studies = ("sweep s.exr -o kept --reference truth --vary screen_trace.cells=8..64", "blame s.exr -o kept")
        for words, what in zip(studies, ("results", "results")):
            subprocess.run(["rm", "-rf", "kept"], check=True)
            log = lambda: os.path.exists("kept/log.jsonl")  # noqa: E731
            said = interrupted(words, log)
            with open("kept/log.jsonl", encoding="utf-8") as file:
                lines = len(file.readlines())
            if lines:
                assert f"{lines} of the {what} are kept in kept" in said or f"{lines} of the {what} and the rays" in said, (lines, said)
            else:
                assert "there is nothing to resume from" in said or "the rays of the reference are kept" in said, said

    # ---- tev ----

    def test_images_of_two_runs_have_two_names_in_tev(self):
        for name in ("run", "other"):
            ok(f"replay s.exr -p kf2 -o {name} --outputs composed")
        names = []
        for path in ("run:composed", "other:composed", "s.exr:gbuffer:normal"):
            server = socket.create_server(("127.0.0.1", 0))
            received = bytearray()

            def listen():
                connection, _ = server.accept()
                while block := connection.recv(65536):
                    received.extend(block)

            listener = threading.Thread(target=listen)
            listener.start()
            ok(f"view {path} --to-tev 127.0.0.1:{server.getsockname()[1]}")
            listener.join(10)
            names.append(bytes(received[6:]).split(b"\0", 1)[0].decode())
        assert names == ["run:composed", "other:composed", "s.exr:gbuffer:normal"], names


with tempfile.TemporaryDirectory() as folder:
    failed = tap.run(Tests(folder))
    os.chdir("/")
sys.exit(failed)
