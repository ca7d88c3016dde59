"""Checks the format, and what clang-format cannot: file lengths, headers that compile alone in C and C++, exported names.
Needs no git, so that it says the same of a clone, of a copy without .git, and of a clone that belongs to another user."""
import fnmatch
import os
import re
import subprocess
import sys
import tempfile

LONGEST = 500
# The filter itself, and passes that process every texel of a face in every plan.
WHOLE_FACES = {"passes/shared/cube_filter.glsl", "passes/shared/cube_chain.glsl", "passes/prepare/cocoon/max.comp",
               "passes/prepare/cubemap_convert/dual_paraboloid.comp"}


def sources():
    """Paths of all files that .gitignore does not exclude."""
    with open(".gitignore", encoding="utf-8") as text:
        left_out = [pattern.strip("/") for pattern in text.read().split()]

    def kept(name):
        return name[0] != "." and not any(fnmatch.fnmatch(name, pattern) for pattern in left_out)

    for folder, below, names in os.walk("."):
        below[:] = filter(kept, below)
        yield from (os.path.relpath(os.path.join(folder, name)) for name in filter(kept, names))


# With arguments, only these files are formatted, and only these headers compiled.
chosen = set(sys.argv[1:])
files = sorted(sources())
if len(files) < 500:
    sys.exit(f"only {len(files)} files in {os.getcwd()}, expected the whole tree")
faults = []
# Headers of passes contain rows for two languages, which clang-format cannot format.
formatted = [f for f in files if (not chosen or f in chosen) and f.endswith((".c", ".h", ".cc")) and not re.search(r"^passes/(?!include/).*\.h$|\.pass\.h$", f)]
run = subprocess.run(["clang-format", "--dry-run", "-Werror", *formatted], capture_output=True, text=True)
if run.returncode:
    faults.append(run.stderr)
for f in files:
    if not f.endswith((".c", ".h", ".cc", ".glsl", ".comp", ".py")):
        continue
    with open(f, encoding="utf-8") as text:
        lines = text.read().split("\n")
    if len(lines) > LONGEST:
        faults.append(f"{f}: {len(lines)} lines, at most {LONGEST}")
    if lines and lines[0].strip() == "":
        faults.append(f"{f}: does not open with its responsibility")
    # Devices may filter cube maps differently depending on neighbouring invocations, which differ from plan to plan.
    if f.startswith("passes/") and f not in WHOLE_FACES:
        faults += [f"{f}:{n}: a filtered lookup of a cube map; expected cube_finest or cube_levels (shared/cube_filter.glsl)"
                   for n, line in enumerate(lines, 1) if re.search(r"samplerCube\w*\([^()]*linear", line)]
    for n, line in enumerate(lines, 1):
        if line.rstrip() != line:
            faults.append(f"{f}:{n}: trailing space")
# The build gives a room the headers of the rooms that it may know; a path with .. would go around it.
for f in files:
    if not f.endswith((".c", ".h", ".cc")):
        continue
    depth = 2 if f.startswith(("replay/", "study/")) else 1
    with open(f, encoding="utf-8") as text:
        for n, line in enumerate(text, 1):
            named = re.match(r'\s*#\s*include\s*"([^"]*\.\./[^"]*)"', line)
            if named and os.path.normpath(os.path.join(os.path.dirname(f), named[1])).split("/")[:depth] != f.split("/")[:depth]:
                faults.append(f"{f}:{n}: includes {named[1]}, which leaves its room; expected a header that the build lets it see")
# What several effects use is in no folder of theirs.
effects = {os.path.basename(os.path.dirname(f)) for f in files if re.fullmatch(r"passes/\w+/effect\.h", f)}
for f in files:
    if f.startswith("passes/") and f.endswith((".h", ".glsl", ".comp")):
        with open(f, encoding="utf-8") as text:
            faults += [f"{f}:{n}: includes {line.split()[1]} of another effect, expected a folder for all" for n, line in enumerate(text, 1)
                       if (named := re.match(r'#include "(\w+)/', line)) and named[1] in effects - {f.split("/")[1]}]
# Engines link libglint-capture on Windows, too.
for f in files:
    if f.startswith("capture-format/") and not f.startswith("capture-format/system/") and f.endswith((".c", ".h", ".cc")):
        with open(f, encoding="utf-8") as text:
            faults += [f"{f}:{n}: {line.strip()}, expected a function of system.h" for n, line in enumerate(text, 1)
                       if re.match(r"\s*#\s*include\s*<(pthread|unistd|fcntl|dirent|sys/|windows)", line)]
generated = tempfile.TemporaryDirectory()
os.mkdir(os.path.join(generated.name, "glint"))
subprocess.run([sys.executable, "passes/table.py", "rows", os.path.join(generated.name, "glint/row_kinds.h")], check=True)
includes = [a for d in ("capture-format", "pack", "passes", "replay", "study", "samples", "selftest") for a in ("-I", f"{d}/include")] + ["-I", generated.name]
for h in (f for f in files if (not chosen or f in chosen) and "/include/glint/" in f and f.endswith(".h")):
    for command in (["gcc", "-std=c11"], ["g++", "-std=c++17", "-x", "c++"]):
        with tempfile.NamedTemporaryFile("w", suffix=".c") as unit:
            unit.write(f'#include "{os.path.abspath(h)}"\n')
            unit.flush()
            run = subprocess.run([*command, "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror", *includes,
                                  unit.name], capture_output=True, text=True)
        if run.returncode:
            faults.append(f"{h}: does not compile alone with {command[0]}:\n{run.stderr}")
# libglint-capture exports exactly what its headers declare.
declared = set()
for name in ("common", "capture", "edit", "exr"):
    with open(f"capture-format/include/glint/{name}.h", encoding="utf-8") as text:
        declared.update(re.findall(r"\b(glint_\w+)\s*\(", re.sub(r"/\*.*?\*/", "", text.read(), flags=re.S)))
with open("capture-format/exports.map", encoding="utf-8") as text:
    shown = set(re.findall(r"\b(glint_\w+);", text.read()))
for name in declared ^ shown:
    faults.append(f"capture-format/exports.map: {name} is " + ("missing" if name in declared else "in no public header"))
# Texts of strangers go out by one function for each destination: JSON by record_text, control sequences by console_code.
for path in (p for p in files if p.endswith((".c", ".cc")) and p.startswith(("viewer-cli/", "replay/", "study/", "pack/"))):
    with open(path, encoding="utf-8") as text:
        code = text.read()
    if re.search(r"json_dumps\((?![^;]*JSON_ENSURE_ASCII)|json_dumpf|json_dump_file", code):
        faults.append(f"{path}: JSON without record_text (record.h)")
    if "\\033" in re.sub(r"console_code\([^;]*;", "", code) and path != "viewer-cli/io/console.c":
        faults.append(f"{path}: a control sequence without console_code (io/console.h)")
# The size of a room is limited, so that it can be understood as a whole.
ROOM_LINES = 2500
for library in ("replay", "study"):
    for room in sorted(d for d in os.listdir(library) if os.path.isdir(f"{library}/{d}") and d != "include"):
        lines = 0
        for name in os.listdir(f"{library}/{room}"):
            with open(f"{library}/{room}/{name}", encoding="utf-8") as text:
                lines += sum(1 for _ in text)
        if lines > ROOM_LINES:
            faults.append(f"{library}/{room}: {lines} lines, at most {ROOM_LINES}: expected two rooms")
print("\n".join(faults), file=sys.stderr)
sys.exit(1 if faults else 0)
