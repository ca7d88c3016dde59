"""A folder as one executable file: single_file.py TOOL. Speaks TAP."""
import os
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../viewer-cli"))
import tap  # noqa: E402

TOOL = sys.argv[1]


class Tests:
    def __init__(self, folder):
        os.chdir(folder)
        os.makedirs("from/bin")
        os.makedirs("from/lib")
        with open("from/bin/prog", "w", encoding="utf-8") as file:
            file.write('#!/bin/sh\necho "$(cat "$(dirname "$0")/../lib/data" | wc -c)"; for a; do echo "<$a>"; done; exit 7\n')
        os.chmod("from/bin/prog", 0o755)
        with open("from/lib/data", "wb") as file:
            file.write(os.urandom(2_000_000))
        subprocess.run([sys.executable, TOOL, "from", "bin/prog", "prog 1", "one.run"], check=True, capture_output=True)
        self.expected = "2000000\n<a b>\n<>\n"

    def start(self, cache, *words, file="./one.run", **more):
        environment = {"PATH": "/usr/bin:/bin", **({"GLINT_BUNDLE_CACHE": cache} if cache else {}), **more}
        return subprocess.Popen([file, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)

    def run(self, *words, **more):
        process = self.start(*words, **more)
        out, err = process.communicate()
        return process.returncode, out, err

    def test_it_runs_with_its_arguments_and_its_status(self):
        for _ in range(2):
            assert self.run("cache", "a b", "") == (7, self.expected, ""), self.run("cache", "a b", "")
        assert len(os.listdir("cache")) == 1

    def test_the_second_start_unpacks_nothing(self):
        _, folder, _ = self.run("once", "--bundle-folder")
        before = os.stat(folder.strip()).st_ctime_ns
        self.run("once")
        assert os.stat(folder.strip()).st_ctime_ns == before and os.listdir("once") == [os.path.basename(folder.strip())]

    def test_the_cache_is_the_user_s(self):
        assert self.run(None, HOME="home", XDG_CACHE_HOME="")[0] == 7 and os.listdir("home/.cache/glint-bundle")
        assert self.run(None, HOME="home2", XDG_CACHE_HOME="xdg")[0] == 7 and os.listdir("xdg/glint-bundle") and not os.path.exists("home2")
        status, out, err = self.run(None)
        assert (status, out) == (1, "") and "GLINT_BUNDLE_CACHE=DIR says where" in err, err

    def test_a_folder_of_others_is_refused(self):
        """What they could put there would be run, also where it is unpacked already."""
        assert self.run("mine")[0] == 7 and os.stat("mine").st_mode & 0o777 == 0o700
        os.symlink("mine", "link")
        status, out, err = self.run("link")
        assert (status, out) == (1, "") and "link is a symbolic link" in err, err
        for mode in (0o720, 0o702, 0o1777):
            os.chmod("mine", mode)
            status, out, err = self.run("mine")
            assert (status, out) == (1, "") and "others may write to mine" in err, (mode, err)
        os.chmod("mine", 0o755)
        assert self.run("mine")[0] == 7

    def test_starts_at_once_do_not_disturb_each_other(self):
        started = [self.start("many", "a b", "") for _ in range(8)]
        for process in started:
            out, err = process.communicate()
            assert (process.returncode, out, err) == (7, self.expected, ""), (process.returncode, out, err)
        assert len(os.listdir("many")) == 1, os.listdir("many")

    def test_an_interrupted_start_leaves_nothing_that_looks_complete(self):
        """A tar that hangs stands for a slow one; the second start is the real one."""
        os.makedirs("slow")
        with open("slow/tar", "w", encoding="utf-8") as file:
            file.write('#!/bin/sh\ntouch started\nmkdir -p "$3/bin"; cp /bin/true "$3/bin/prog"; exec sleep 60\n')
        os.chmod("slow/tar", 0o755)
        for kind in (signal.SIGKILL, signal.SIGTERM):
            process = subprocess.Popen(["./one.run"], env={"PATH": os.path.abspath("slow") + ":/usr/bin:/bin", "GLINT_BUNDLE_CACHE": "killed"},
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
            while not os.path.exists("started"):
                time.sleep(0.01)
            os.unlink("started")
            os.killpg(process.pid, kind)
            process.wait()
        left = os.listdir("killed")
        assert all(name.startswith("part-") for name in left) and len(left) <= 1, left
        assert self.run("killed", "a b", "") == (7, self.expected, "")

    def test_damage_is_noticed_before_anything_is_unpacked(self):
        with open("one.run", "rb") as file:
            data = file.read()
        for name, damaged in (("short.run", data[:-1000]), ("flipped.run", data[:-500] + bytes([data[-500] ^ 1]) + data[-499:])):
            with open(name, "wb") as file:
                file.write(damaged)
            os.chmod(name, 0o755)
            status, out, err = self.run("damaged", file=f"./{name}")
            assert (status, out) == (1, "") and f"./{name}: is damaged or not whole: expected the checksum " in err, err
            assert not os.path.exists("damaged")

    def test_a_folder_that_cannot_be_made_is_named(self):
        with open("file", "w", encoding="utf-8"):
            pass
        status, out, err = self.run("file/below")
        assert (status, out) == (1, "") and "cannot make the folder file/below; GLINT_BUNDLE_CACHE=DIR names another one" in err, err

    def test_another_version_has_a_folder_of_its_own(self):
        shutil.copytree("from", "newer")
        with open("newer/lib/data", "ab") as file:
            file.write(b"more")
        subprocess.run([sys.executable, TOOL, "newer", "bin/prog", "prog 2", "two.run"], check=True, capture_output=True)
        assert self.run("both")[1] == "2000000\n" and self.run("both", file="./two.run")[1] == "2000004\n" and len(os.listdir("both")) == 2

    def test_the_same_contents_give_the_same_bytes(self):
        shutil.copytree("from", "copy")
        os.utime("copy/lib/data", (1, 1))
        subprocess.run([sys.executable, TOOL, "copy", "bin/prog", "prog 1", "again.run"], check=True, capture_output=True)
        with open("one.run", "rb") as one, open("again.run", "rb") as again:
            assert one.read() == again.read()
        assert os.stat("again.run").st_mode & stat.S_IXUSR


with tempfile.TemporaryDirectory() as temporary:
    status = tap.run(Tests(temporary))
sys.exit(status)
