"""Writes a self-contained folder: bundle.py BUILD GLINT_CAPTURE DIR. It runs on x86-64 Linux with glibc >= 2.36 and a
Vulkan driver; glibc and drivers stay the machine's own."""
import os
import re
import shutil
import subprocess
import sys

GLIBC = re.compile(r"/(ld-linux|libc|libm|libdl|libpthread|librt|libresolv|libutil|libmvec)[-.]")


def libraries(program):
    """All shared libraries of the program except those of glibc."""
    lines = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout.split("\n")
    paths = [line.split("=>")[1].split("(")[0].strip() for line in lines if "=>" in line]
    missing = [line.strip() for line in lines if "not found" in line]
    if missing:
        sys.exit("bundle: " + "; ".join(missing))
    return sorted(p for p in paths if p and not GLIBC.search(p))


def licences(paths, folder):
    """The copyright files of the packages of the libraries, and of the font in the program."""
    os.mkdir(folder)
    packages = {"fonts-dejavu-core"}
    found = subprocess.run(["dpkg", "-S", *map(os.path.realpath, paths)], capture_output=True, text=True)
    packages.update(line.split(":")[0] for line in found.stdout.split("\n") if line)
    for package in packages:
        shutil.copy(f"/usr/share/doc/{package}/copyright", os.path.join(folder, package))
    # the charting library in the program
    shutil.copytree("viewer-cli/vendor/echarts", os.path.join(folder, "echarts"), ignore=shutil.ignore_patterns("*.js"))


def main():
    build, capture, folder = sys.argv[1:]
    if os.path.exists(folder) and os.listdir(folder) and not os.path.exists(os.path.join(folder, "bin", "glint")):
        sys.exit(f"bundle: {folder} exists and is no bundle; name an empty or a new folder")
    temporary = folder.rstrip("/") + ".tmp-bundle"
    shutil.rmtree(temporary, ignore_errors=True)
    stage = os.path.join(temporary, "stage")
    subprocess.run(["meson", "install", "-C", build, "--quiet", "--no-rebuild", "--destdir", os.path.abspath(stage)], check=True)
    (prefix,) = (os.path.dirname(root) for root, _, files in os.walk(stage) if root.endswith("/bin") and "glint" in files)
    for part in ("bin", "share"):
        shutil.move(os.path.join(prefix, part), os.path.join(temporary, part))
    lib = os.path.join(temporary, "lib")
    os.mkdir(lib)
    # glint pack loads the second one by its name when an image needs OpenImageIO; it brings most of the size.
    loaded = os.path.join(build, "pack", "libglint-oiio.so")
    needed = sorted({*libraries(os.path.join(build, "viewer-cli", "glint")), loaded, *libraries(loaded)})
    licences(needed, os.path.join(temporary, "licences"))
    for path in needed:
        target = os.path.join(lib, os.path.basename(path))
        shutil.copy(path, target)
        os.chmod(target, 0o755)
        subprocess.run(["strip", "--strip-unneeded", target], check=True)
        subprocess.run(["patchelf", "--set-rpath", "$ORIGIN", target], check=True)
    program = os.path.join(temporary, "bin", "glint")
    subprocess.run(["strip", program], check=True)
    subprocess.run(["patchelf", "--set-rpath", "$ORIGIN/../lib", program], check=True)
    strays = [p for start in (program, os.path.join(lib, os.path.basename(loaded))) for p in libraries(start)
              if os.path.dirname(os.path.realpath(p)) != os.path.realpath(lib)]
    if strays:
        sys.exit("bundle: still taken from this machine: " + ", ".join(strays))
    shutil.copy(capture, os.path.join(temporary, "sample.exr"))
    shutil.copy("LICENSE", temporary)
    with open(os.path.join(temporary, "README"), "w", encoding="utf-8") as readme:
        readme.write("glint, self-contained. Needs glibc 2.36 or newer and a Vulkan driver.\n\n"
                     "    bin/glint devices\n    bin/glint replay sample.exr -o run\n"
                     "    bin/glint view run -o picture.png\n")
    shutil.rmtree(stage)
    shutil.rmtree(folder, ignore_errors=True)
    os.rename(temporary, folder)
    size = sum(os.path.getsize(os.path.join(r, f)) for r, _, files in os.walk(folder) for f in files)
    print(f"{folder}: {size / 1e6:.0f} MB; bin/glint devices is a first thing to try there")


main()
