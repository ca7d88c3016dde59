"""What is installed is hardened: hardening.py BUILD-FOLDER CC FORTIFIED. Installs the build folder into a temporary one, and reads each ELF file there with readelf."""
import glob
import os
import re
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "viewer-cli"))
import tap
import programs

BUILD, CC, FORTIFIED = sys.argv[1], sys.argv[2], sys.argv[3] == "true"
CHECKABLE = r"UND v?(f|sn?)?printf(@|$)"  # what FORTIFY replaces wherever it stands; of others only where it knows the size of what they write
LIBRARY_PATHS = {"$ORIGIN", "$ORIGIN/../lib", "$ORIGIN/../lib/x86_64-linux-gnu", "$ORIGIN/../lib64"}


def read(option, path):
    return subprocess.run([programs.find("readelf"), "--wide", option, path], check=True, capture_output=True, text=True).stdout


def faults(path, fortified):
    """What an attacker of a program that has this file would be glad about."""
    segments, dynamic, symbols = read("--segments", path), read("--dynamic", path), read("--dyn-syms", path)
    paths = {p for found in re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.*)\]", dynamic) for p in found.split(":")}
    found = {
        "not position-independent": not re.search(r"Type:\s+DYN", read("--file-header", path)),
        "a stack that is executable": not re.search(r"GNU_STACK.* RW +0x", segments),
        "memory that is writable and executable": bool(re.search(r"^ +LOAD.* RWE ", segments, re.M)),
        "no read-only relocations": "GNU_RELRO" not in segments,
        "symbols that are bound late": not re.search(r"\(FLAGS(_1)?\).*\b(BIND_)?NOW\b|\(BIND_NOW\)", dynamic),
        "relocations in code": "TEXTREL" in dynamic,
        f"libraries from elsewhere: {', '.join(sorted(paths - LIBRARY_PATHS))}": bool(paths - LIBRARY_PATHS),
        "no stack protector": "__stack_chk_fail" not in symbols,
        "no checked functions of the C library": fortified and bool(re.search(CHECKABLE, symbols, re.M)) and not re.search(r"__(?!stack)\w+_chk\b", symbols),
    }
    return [name for name, is_so in found.items() if is_so]


def is_elf(path):
    with open(path, "rb") as file:
        return file.read(4) == b"\x7fELF"


class Tests:
    def __init__(self, folder):
        self.folder = folder

    def test_what_is_installed_is_hardened(self):
        tree = os.path.join(self.folder, "tree")
        subprocess.run(["meson", "install", "-C", BUILD, "--destdir", tree, "--no-rebuild", "--quiet"], check=True, stdout=subprocess.DEVNULL)
        files = [p for p in glob.glob(tree + "/**", recursive=True) if os.path.isfile(p) and not os.path.islink(p) and is_elf(p)]
        names = {os.path.basename(p).split(".so")[0] for p in files}
        assert names >= {"glint", "libglint-capture", "libglint-replay", "libglint-study", "libglint-pack", "libglint-oiio"}, names
        found = {os.path.basename(p): faults(p, FORTIFIED) for p in files}
        assert not any(found.values()), found

    def test_only_the_owner_may_write_what_is_installed(self):
        tree = os.path.join(self.folder, "modes")
        old = os.umask(0o022)
        try:
            subprocess.run(["meson", "install", "-C", BUILD, "--destdir", tree, "--no-rebuild", "--quiet"], check=True, stdout=subprocess.DEVNULL)
        finally:
            os.umask(old)
        wide = [p for p in glob.glob(tree + "/**", recursive=True) if not os.path.islink(p) and os.stat(p).st_mode & 0o6022]
        assert not wide, wide

    def test_each_fault_is_found(self):
        """A program that has everything, and the same without one thing."""
        source = os.path.join(self.folder, "program.c")
        with open(source, "w", encoding="utf-8") as file:
            file.write('#include <stdio.h>\n#include <string.h>\nint main(int count, char **words) {\n    char text[64];\n'
                       '    strcpy(text, words[count - 1]);\n    return printf("%s\\n", text) < 0;\n}\n')
        good = ["-O2", "-fPIE", "-pie", "-fstack-protector-strong", "-U_FORTIFY_SOURCE", "-D_FORTIFY_SOURCE=2", "-Wl,-z,relro", "-Wl,-z,now", "-Wl,-z,noexecstack",
                "-Wl,-rpath,$ORIGIN/../lib"]
        for more, fault in [([], None), (["-fno-PIE", "-no-pie"], "not position-independent"), (["-Wl,-z,execstack"], "a stack that is executable"),
                            (["-Wl,-z,norelro"], "no read-only relocations"), (["-Wl,-z,lazy"], "symbols that are bound late"),
                            (["-Wl,-rpath,/tmp"], "libraries from elsewhere: /tmp"), (["-Wl,-rpath,$ORIGIN/.."], "libraries from elsewhere: $ORIGIN/.."),
                            (["-fno-stack-protector"], "no stack protector"), (["-U_FORTIFY_SOURCE"], "no checked functions of the C library")]:
            program = os.path.join(self.folder, "program")
            subprocess.run([CC, *good, *more, source, "-o", program], check=True, stderr=subprocess.DEVNULL)
            assert faults(program, True) == ([fault] if fault else []), (more, faults(program, True))


with tempfile.TemporaryDirectory(prefix="glint-hardening-") as work:
    sys.exit(tap.run(Tests(work)))
