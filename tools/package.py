"""Makes a Debian package of an installed build: package.py BUILD FOLDER. Which packages it depends on is what dpkg-shlibdeps finds; lintian must have
nothing to say. Prints the path of the package."""
import glob
import gzip
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

LIBRARIES = "usr/lib/glint" # private: nobody else links them, engines use ./dev install
DESCRIPTION = """Description: replay the reflection passes of captured frames offline
 glint takes one captured frame of a game or engine (G-buffer, lit colour, cube
 maps, camera, in one OpenEXR file), runs any subset of its reflection passes
 on Vulkan, and writes every intermediate image back. It measures what each
 bit of accuracy costs, and which pass causes which part of the error.
 .
 It needs a Vulkan 1.3 driver; mesa-vulkan-drivers has one for machines
 without a GPU, too.
"""


def output(*words, **more):
    return subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True, **more).stdout.strip()


def compress(path):
    with open(path, "rb") as file, open(path + ".gz", "wb") as to, gzip.GzipFile(filename="", fileobj=to, mode="wb", mtime=0) as zipped:
        zipped.write(file.read())
    os.unlink(path)


def move(source, target):
    os.makedirs(os.path.dirname(target), exist_ok=True)
    shutil.move(source, target)


def take_files(build, root):
    """Of what an installation has: the program, its libraries, man pages, completions, presets."""
    stage = root + ".stage"
    subprocess.run(["meson", "install", "-C", build, "--quiet", "--no-rebuild", "--destdir", os.path.abspath(stage)], check=True)
    (prefix,) = (os.path.dirname(folder) for folder, _, files in os.walk(stage) if folder.endswith("/bin") and "glint" in files)
    move(f"{prefix}/bin/glint", f"{root}/usr/bin/glint")
    for path in glob.glob(f"{prefix}/lib/**/libglint-*.so*", recursive=True):
        name = os.path.basename(path)
        if re.search(r"\.so\.\d+$", name) or name == "libglint-oiio.so": # the names that programs load
            target = f"{root}/{LIBRARIES}/{name}"
            os.makedirs(os.path.dirname(target), exist_ok=True)
            shutil.copy(path, target)
    share = f"{root}/usr/share"
    for folder in ("man", "bash-completion", "fish", "glint", "doc"):
        move(f"{prefix}/share/{folder}", f"{share}/{folder}")
    move(f"{prefix}/share/zsh/site-functions/_glint", f"{share}/zsh/vendor-completions/_glint")
    os.rename(f"{share}/bash-completion/completions/glint.bash", f"{share}/bash-completion/completions/glint")
    shutil.rmtree(f"{share}/glint/python") # it looks for the libraries of an installation
    for page in glob.glob(f"{share}/man/man1/*.1"):
        compress(page)
    shutil.rmtree(stage)


def finish_binaries(root):
    binaries = [f"{root}/usr/bin/glint", *glob.glob(f"{root}/{LIBRARIES}/*")]
    for path in binaries:
        program = path.endswith("/glint")
        subprocess.run(["strip", *([] if program else ["--strip-unneeded"]), "--remove-section=.comment", "--remove-section=.note", path], check=True)
        subprocess.run(["patchelf", "--set-rpath", "/" + LIBRARIES, path], check=True)
        os.chmod(path, 0o755 if program else 0o644)
    return binaries


def dependencies(root, binaries):
    """OpenImageIO is loaded when glint pack reads an image of its formats, so that its packages, about 200, are suggested only."""
    with tempfile.TemporaryDirectory() as work:
        os.mkdir(f"{work}/debian")
        with open(f"{work}/debian/control", "w", encoding="utf-8") as file:
            file.write("Source: glint\n\nPackage: glint\nArchitecture: any\n")
        os.mkdir(f"{root}/DEBIAN")
        loaded = [path for path in binaries if path.endswith("-oiio.so")]
        needed = [path for path in binaries if path not in loaded]
        text = output("dpkg-shlibdeps", "-O", f"-S{os.path.abspath(root)}", f"-l{os.path.abspath(root)}/{LIBRARIES}",
                      "-dDepends", *(f"-e{os.path.abspath(path)}" for path in needed),
                      "-dSuggests", *(f"-e{os.path.abspath(path)}" for path in loaded), cwd=work)
    found = dict(line.removeprefix("shlibs:").split("=", 1) for line in text.splitlines())
    found["Recommends"] = "mesa-vulkan-drivers | vulkan-icd"
    return found


def who():
    name = os.environ.get("DEBFULLNAME") or "The glint authors"
    return f"{name} <{os.environ.get('DEBEMAIL') or 'glint@debian.invalid'}>"


def write_documents(root, version):
    doc = f"{root}/usr/share/doc/glint"
    date = time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH") or output("git", "log", "-1", "--format=%ct") or time.time()))
    with open(f"{doc}/changelog", "w", encoding="utf-8") as file:
        file.write(f"glint ({version}) bookworm; urgency=medium\n\n  * Made by ./dev package; CHANGES.md of the sources says what there is.\n\n"
                   f" -- {who()}  {time.strftime('%a, %d %b %Y %H:%M:%S +0000', date)}\n")
    compress(f"{doc}/changelog")
    with open(f"{doc}/copyright", "w", encoding="utf-8") as file:
        for title, path in (("glint", "LICENSE"), ("Built in: Apache ECharts", "viewer-cli/vendor/echarts/NOTICE"),
                            *((f"Built in, from the package {p}", f"/usr/share/doc/{p}/copyright") for p in
                              ("fonts-dejavu-core", "glslang-dev", "spirv-tools"))):
            with open(path, encoding="utf-8") as part:
                file.write(f"{title}\n{'-' * len(title)}\n\n{part.read().strip()}\n\n")
        file.write("The Apache License 2.0 of Apache ECharts is in /usr/share/common-licenses/Apache-2.0.\n")


def write_control(root, version, found):
    size = sum(os.path.getsize(os.path.join(folder, name)) for folder, _, names in os.walk(root) for name in names)
    with open(f"{root}/DEBIAN/control", "w", encoding="utf-8") as file:
        file.write(f"Package: glint\nVersion: {version}\nArchitecture: {output('dpkg', '--print-architecture')}\nMaintainer: {who()}\n"
                   f"Installed-Size: {size // 1024}\nDepends: {found['Depends']}\nRecommends: {found['Recommends']}\n"
                   f"Suggests: {found['Suggests']}\n"
                   f"Section: graphics\nPriority: optional\n{DESCRIPTION}")
    with open(f"{root}/DEBIAN/md5sums", "w", encoding="utf-8") as sums:
        for folder, _, names in sorted(os.walk(f"{root}/usr")):
            for name in sorted(names):
                with open(os.path.join(folder, name), "rb") as file:
                    sums.write(f"{hashlib.md5(file.read()).hexdigest()}  {os.path.relpath(os.path.join(folder, name), root)}\n")
    for folder, folders, names in os.walk(root):
        for name in folders:
            os.chmod(os.path.join(folder, name), 0o755)
        for name in names:
            path = os.path.join(folder, name)
            os.chmod(path, 0o755 if os.path.dirname(path).endswith("usr/bin") else 0o644)


def main():
    build, folder = sys.argv[1:]
    os.makedirs(folder, exist_ok=True)
    version = output(f"{build}/viewer-cli/glint", "--version").split()[1]
    with tempfile.TemporaryDirectory(dir=folder, prefix="package.tmp-") as work:
        root = f"{work}/root"
        os.mkdir(root)
        take_files(build, root)
        found = dependencies(root, finish_binaries(root))
        write_documents(root, version)
        write_control(root, version, found)
        path = f"{folder}/glint_{version}_{output('dpkg', '--print-architecture')}.deb"
        subprocess.run(["dpkg-deb", "--root-owner-group", "-Zxz", "--build", root, path], check=True, stdout=subprocess.DEVNULL)
    print(f"Depends: {found['Depends']}\nRecommends: {found['Recommends']}\nSuggests: {found['Suggests']}", file=sys.stderr)
    subprocess.run(["lintian", "--allow-root", "--fail-on", "error,warning", path], check=True, stdout=sys.stderr)
    print(path)


main()
