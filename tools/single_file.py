"""Makes one executable file of a folder: a shell script with the packed folder behind it, which unpacks itself into a cache folder and runs the program
there: single_file.py FOLDER PROGRAM NAME FILE. The same contents give the same bytes."""
import gzip
import hashlib
import io
import os
import sys
import tempfile
import tarfile

START = 10 # digits of the place where the packed folder begins


def packed(folder):
    """A tar.gz of the folder's contents, without owners and times."""
    def plain(info):
        info.uid = info.gid = info.mtime = 0
        info.uname = info.gname = ""
        return info
    file = io.BytesIO()
    with gzip.GzipFile(fileobj=file, mode="wb", compresslevel=6, mtime=0) as zipped, tarfile.open(fileobj=zipped, mode="w", format=tarfile.GNU_FORMAT) as tar:
        for name in sorted(os.listdir(folder)):
            tar.add(os.path.join(folder, name), arcname=name, filter=plain)
    return file.getvalue()


def write(folder, program, name, path):
    data = packed(folder)
    size = sum(os.path.getsize(os.path.join(root, f)) for root, _, files in os.walk(folder) for f in files)
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "single_file.sh"), encoding="utf-8") as file:
        script = file.read()
    for word, text in (("SUM", hashlib.sha256(data).hexdigest()), ("NAME", name), ("PROGRAM", program), ("MEGABYTES", f"{size / 1e6:.0f}")):
        script = script.replace(f"@{word}@", text)
    length = len(script.replace("@START@", "0" * START).encode())
    script = script.replace("@START@", f"{length + 1:<{START}}") # tail counts from 1; blanks end the line
    number, temporary = tempfile.mkstemp(prefix=os.path.basename(path) + ".tmp-", dir=os.path.dirname(path) or ".")
    with open(number, "wb") as file:
        file.write(script.encode() + data)
    os.chmod(temporary, 0o755)
    os.rename(temporary, path)
    return length + len(data)


if __name__ == "__main__":
    size = write(*sys.argv[1:])
    print(f"{sys.argv[4]}: {size / 1e6:.0f} MB; one file that runs on any x86-64 Linux with glibc 2.36 or newer and a Vulkan driver")
