"""Tests a Windows build of libglint-capture under Wine, compares what it writes with what Linux writes, and leaves a folder to link with.
usage: windows.py BUILD-WINDOWS BUILD-NATIVE FOLDER"""
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

WINE = "/usr/lib/wine/wine64"
WINESERVER = "/usr/lib/wine/wineserver"
MINGW = "x86_64-w64-mingw32"
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
README = """libglint-capture {version} for Windows, x86-64: writes and reads captures of frames for glint.

MinGW, in one file:  x86_64-w64-mingw32-gcc integration/integration.c integration/engine.c -Iinclude -Llib -static -lglint-capture -lz
MinGW, with the DLL: x86_64-w64-mingw32-gcc integration/integration.c integration/engine.c -Iinclude lib/libglint-capture.dll.a
                     and bin/libglint-capture-0.dll beside the program. It needs KERNEL32.dll and msvcrt.dll, which every Windows has.
C++:                 g++ in place of gcc for integration.cc; engine.c stays C.
MSVC (untried):      lib /def:lib\\glint-capture.def /name:libglint-capture-0.dll /machine:x64 /out:glint-capture.lib, and link the DLL by it.

Paths are UTF-8. LICENSES has those of the libraries that these files contain.
"""


def say(text):
    print(text, flush=True)


def run(*command, **more):
    return subprocess.run(command, check=True, **more)


def digest(path):
    with open(path, "rb") as data:
        return hashlib.sha256(data.read()).hexdigest()


def test(build):
    """Runs the tests under Wine, and counts their cases."""
    done = subprocess.run(["meson", "test", "-C", build, "--no-rebuild", "--quiet", "--print-errorlogs", "--num-processes", "2",
                           "--timeout-multiplier", os.environ.get("GLINT_PATIENCE", "4")])
    cases = list(xml.parse(os.path.join(build, "meson-logs/testlog.junit.xml")).iter("testcase"))
    failed = [case for case in cases if case.find("failure") is not None or case.find("error") is not None]
    if done.returncode or failed or not cases:
        sys.exit(f"{len(cases) - len(failed)} tests passed under Wine, {len(failed)} failed; see {build}/meson-logs/testlog.txt")
    say(f"{len(cases)} tests passed under Wine")


def compare(windows, native, folder):
    """The same input gives the same bytes on both systems: the example's frame, and every role in every compression."""
    programs = [("capture-format/integration", []), ("capture-format/integration_cc", [])]
    programs += [("tests/capture-format/statistics", [str(compression)]) for compression in range(6)]
    for program, arguments in programs:
        ours, theirs = os.path.join(folder, "linux.exr"), os.path.join(folder, "windows.exr")
        run(os.path.join(native, program), ours, *arguments, stdout=subprocess.DEVNULL)
        run(WINE, os.path.join(windows, program + ".exe"), "Z:" + theirs, *arguments, stdout=subprocess.DEVNULL)
        if digest(ours) != digest(theirs):
            sys.exit(f"{program} {' '.join(arguments)}: Windows writes other bytes than Linux")
    say(f"{len(programs)} captures have the same bytes from Linux and from Windows")


def package(windows, folder):
    """Headers, libraries, examples, licences."""
    shutil.rmtree(folder, ignore_errors=True)
    lib, binaries, licenses = (os.path.join(folder, name) for name in ("lib", "bin", "LICENSES"))
    for name in (lib, binaries, licenses):
        os.makedirs(name)
    shutil.copytree(os.path.join(ROOT, "capture-format/include"), os.path.join(folder, "include"))
    shutil.copytree(os.path.join(ROOT, "capture-format/integration"), os.path.join(folder, "integration"))
    built = os.path.join(windows, "capture-format")
    for name, to in (("libglint-capture.a", lib), ("libglint-capture.dll.a", lib), ("glint-capture.def", lib), ("libglint-capture-0.dll", binaries)):
        shutil.copy(os.path.join(built, name), to)
    shutil.copy(f"/usr/{MINGW}/lib/libz.a", lib)
    run(f"{MINGW}-strip", "--strip-unneeded", os.path.join(binaries, "libglint-capture-0.dll"))
    run(f"{MINGW}-strip", "--strip-debug", os.path.join(lib, "libglint-capture.a"))
    shutil.copy(os.path.join(ROOT, "LICENSE"), os.path.join(licenses, "glint"))
    for name, path in (("OpenEXR", "openexr-3.1.5/LICENSE.md"), ("Imath", "Imath-3.1.6/LICENSE.md"), ("libdeflate", "libdeflate-1.14/COPYING"),
                       ("xxHash", "xxHash-0.8.1/LICENSE")):
        shutil.copy(os.path.join(ROOT, "subprojects", path), os.path.join(licenses, name))
    shutil.copy("/usr/share/doc/libz-mingw-w64-dev/copyright", os.path.join(licenses, "zlib"))
    with open(os.path.join(ROOT, "meson.build"), encoding="utf-8") as text:
        version = text.read().split("version: '", 1)[1].split("'", 1)[0]
    with open(os.path.join(folder, "README.txt"), "w", encoding="utf-8") as text:
        text.write(README.format(version=version))


def link(folder, native, place):
    """The examples build against the folder as its README says, run, and write what Linux writes."""
    expected = os.path.join(place, "expected.exr")
    run(os.path.join(native, "capture-format/integration"), expected)
    engine = os.path.join(place, "engine.o")
    run(f"{MINGW}-gcc", "-c", os.path.join(folder, "integration/engine.c"), "-o", engine)
    for compiler, source in (("gcc", "integration.c"), ("g++", "integration.cc")):
        for name, options in (("static", ["-L" + os.path.join(folder, "lib"), "-static", "-lglint-capture", "-lz"]),
                              ("DLL", [os.path.join(folder, "lib/libglint-capture.dll.a"), "-static-libgcc", "-static-libstdc++"])):
            program, written = os.path.join(place, "linked.exe"), os.path.join(place, "linked.exr")
            run(f"{MINGW}-{compiler}", os.path.join(folder, "integration", source), engine, "-I" + os.path.join(folder, "include"), *options, "-o", program)
            shutil.copy(os.path.join(folder, "bin/libglint-capture-0.dll"), place)
            run(WINE, program, "Z:" + written)
            if digest(written) != digest(expected):
                sys.exit(f"{source}, {name}: other bytes than Linux's")
    say("the examples link with it in C and C++, static and with the DLL, and write Linux's bytes")


def main(windows, native, folder):
    with tempfile.TemporaryDirectory() as place:
        os.environ.update(WINEPREFIX=os.path.join(place, "wine"), WINEDEBUG="-all", WINEDLLOVERRIDES="mscoree,mshtml=")
        os.mkdir(os.environ["WINEPREFIX"])
        run(WINESERVER, "-p")  # stays between programs, whose start is quick then
        try:
            run(WINE, "wineboot", "-i", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            test(windows)
            compare(windows, native, place)
            package(windows, folder)
            link(folder, native, place)
        finally:
            subprocess.run([WINESERVER, "-k"], check=False)
    for name in sorted(os.path.join(at, name) for at, _, names in os.walk(folder) for name in names):
        if name.endswith((".a", ".dll", ".txt")):
            say(f"{os.path.getsize(name) / 1024:7.0f} KiB  {name}")


main(*map(os.path.abspath, sys.argv[1:]))
