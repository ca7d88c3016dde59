"""Changes files as somebody might who wants glint to fail: JSON by its values, EXR by its attributes, texts by their lines, folders by their entries."""
import json
import os
import struct

NUMBERS = ["0", "-1", "1", "0.5", "65535", "65536", "2147483647", "2147483648", "4294967295", "4294967296", "9223372036854775807", "-9223372036854775808", "1e19", "1e308",
           "-1e-300", "1e-45", "3.4028235e38", "1e999", "NaN", "Infinity", "-0.0", "123456789012345678901234567890", "00", "+1", "0x10", ".5"]
TEXTS = ["", ".", "..", "/", "../../secret", "/etc/passwd", "/dev/zero", "/dev/stdin", "run.json", "%s%n%s%n", "a" * 300, "b" * 70000, "\x1b[31mred\x1b[0m\x07", "a\nb\rc", "\u202egnp.exe",
         "<script>alert(1)</script>", "&quot;'\"", "ü" * 200, "\U0001f600", "nan", "inf", "-1", "none", "R G B A", "R G B A R", "R32UI", "RGBA16F", "composed", "composed.level1"]
WRONG_UTF8 = b'"\xff\xc3\x28\xf0\x28\x8c\xbc"'


class Raw:
    """Bytes of a JSON text that stand for a value."""

    def __init__(self, data):
        self.data = data if isinstance(data, bytes) else data.encode()


def parse(data):
    """Objects become lists of pairs in a Members, so that a name can stand twice."""
    return json.loads(data, object_pairs_hook=Members, parse_float=Raw)


class Members(list):
    """The pairs of an object."""


def dump(value):
    if isinstance(value, Raw):
        return value.data
    if isinstance(value, Members):
        return b"{" + b",\n".join(dump(k) + b": " + dump(v) for k, v in value) + b"}"
    if isinstance(value, list):
        return b"[" + b", ".join(map(dump, value)) + b"]"
    return json.dumps(value, ensure_ascii=False).encode("utf-8", "surrogatepass")


def json_value(rng):
    return rng.choice([
        lambda: Raw(rng.choice(NUMBERS)), lambda: Raw(rng.choice(NUMBERS)), lambda: rng.choice(TEXTS), lambda: rng.choice(TEXTS),
        lambda: rng.choice([None, True, False]), lambda: [], Members, lambda: Raw(WRONG_UTF8), lambda: Raw('"\\u0000"'), lambda: Raw('"\\ud800"'),
        lambda: Raw(b"[" * rng.choice([10, 2000, 2100, 100000]) + b"]" * rng.choice([10, 2000])), lambda: [Raw(n) for n in rng.sample(NUMBERS, 4)],
        lambda: Raw(b"[" + b"{}," * rng.choice([1000, 100000]) + b"{}]"),
        lambda: Members([("x" * 1000, 1)] * 3)])()


def places(value, found):
    """(container, index) of every value below."""
    if isinstance(value, list):
        for i, item in enumerate(value):
            found.append((value, i))
            places(item[1] if isinstance(value, Members) else item, found)
    return found


def mutate_json(data, rng):
    """Two of three changes keep the text well-formed; the others hit its bytes."""
    if rng.random() < 0.2:
        return mutate_text(data, rng)
    try:
        root = parse(data)
    except (ValueError, RecursionError):  # an earlier change broke it
        return mutate_text(data, rng)
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        found = places(root, [])
        if not found:
            break
        container, i = rng.choice(found)
        how = rng.random()
        if how < 0.15:
            del container[i]
        elif how < 0.25:
            container.insert(i, container[i])
        elif how < 0.30:
            container.extend(container[i:i + 1] * rng.choice([10, 1000, 5000]))
        elif how < 0.37 and isinstance(container, Members):
            container[i] = (rng.choice(TEXTS), container[i][1])
        elif how < 0.45:
            other, k = rng.choice(found)
            if k < len(other):
                item = other[k][1] if isinstance(other, Members) else other[k]
                item = Raw(dump(item))  # a copy, so that nothing contains itself
                container[i] = (container[i][0], item) if isinstance(container, Members) else item
        else:
            value = json_value(rng)
            container[i] = (container[i][0], value) if isinstance(container, Members) else value
    return dump(root)


def mutate_bytes(data, rng):
    """As hostile_damage in tests/capture-format/hostile.c: two of three changes hit the first 16 KiB."""
    data = bytearray(data)
    words = [0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x10000, 0x7F800000, 0x7FC00000, 255, 65536 * 6, 0xFFFFFFF0]
    for _ in range(rng.choice([1, 1, 2, 4])):
        if not data:
            break
        at = rng.randrange(min(len(data), 16384) if rng.random() < 0.67 else len(data))
        how = rng.randrange(6)
        if how == 0:
            data[at] ^= 1 << rng.randrange(8)
        elif how == 1:
            data[at] = rng.randrange(256)
        elif how == 2:
            data[at:at + 4] = struct.pack("<I", rng.choice(words))
        elif how == 3:
            data[at:at + 8] = struct.pack("<II", rng.choice(words), rng.choice(words))
        elif how == 4:
            origin = rng.randrange(len(data))
            data[at:at + 64] = data[origin:origin + 64]
        else:
            del data[rng.randrange(len(data)):]
    return bytes(data)


def exr_attributes(data):
    """(position of the size, type, size) of every attribute in the headers of an EXR file."""
    found, at, multi = [], 8, bool(data[5] & 0x10)
    while at < len(data):
        if data[at] == 0:
            at += 1
            if not multi or at >= len(data) or data[at] == 0:
                break
            continue
        name = data.find(0, at)
        kind = data.find(0, name + 1)
        size = struct.unpack_from("<i", data, kind + 1)[0] if at < name < kind < len(data) - 5 else -1
        if size < 0 or size > len(data):  # an earlier change broke it
            break
        found.append((kind + 1, bytes(data[name + 1:kind]), size))
        at = kind + 5 + size
    return found


def mutate_exr(data, rng):
    if rng.random() < 0.4 or data[:4] != b"\x76\x2f\x31\x01":
        return mutate_bytes(data, rng)
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2])):
        attributes = exr_attributes(data)
        if not attributes:
            return mutate_bytes(data, rng)
        at, kind, size = rng.choice(attributes)
        how = rng.random()
        if how < 0.15:
            struct.pack_into("<i", data, at, rng.choice([-1, 0, 1, size + 1, size - 1, 0x7FFFFFFF]))
            break  # the list of attributes cannot be walked any more
        if kind in (b"box2i", b"v2i", b"int") and size >= 4:
            word = rng.choice([0, 1, -1, 15, 16, 255, 65535, 65536, 1 << 24, 0x7FFFFFFF, -0x80000000])
            struct.pack_into("<i", data, at + 4 + 4 * rng.randrange(size // 4), word)
        elif size > 0:
            data[at + 4 + rng.randrange(size)] = rng.choice([0, 1, 2, 3, 5, 9, 10, 127, 255, rng.randrange(256)])
    return bytes(data)


def mutate_text(data, rng):
    lines = data.split(b"\n")
    for _ in range(rng.choice([1, 1, 2, 3])):
        i = rng.randrange(len(lines))
        how = rng.randrange(9)
        if how == 0:
            del lines[i]
            lines = lines or [b""]
        elif how == 1:
            lines.insert(i, lines[rng.randrange(len(lines))])
        elif how == 2:
            lines[i] = lines[i][:rng.randrange(len(lines[i]) + 1)]
        elif how == 3 and lines[i]:
            k = rng.randrange(len(lines[i]))
            lines[i] = lines[i][:k] + bytes([rng.choice([0, 9, 13, 27, 34, 44, 58, 91, 93, 123, 125, 128, 255, rng.randrange(256)])]) + lines[i][k + 1:]
        elif how == 4:
            words = lines[i].split(b" ")
            words[rng.randrange(len(words))] = rng.choice(NUMBERS + TEXTS).encode("utf-8", "surrogatepass")
            lines[i] = b" ".join(words)
        elif how == 5:
            lines[i] = lines[i] * rng.choice([2, 100, 5000])
        elif how == 6:
            lines.insert(i, rng.choice([b"\xff\xfe" * 20, b"\x00" * 100, b"#" * 100000, b"(" * 30000, b"[" * 30000, b"  " * 3000 + b"x"]))
        elif how == 7:
            lines = lines[:i + 1]
        else:
            k = rng.randrange(len(lines))
            lines[i], lines[k] = lines[k], lines[i]
    return b"\n".join(lines)


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


def read(path):
    with open(path, "rb") as file:
        return file.read(1 << 25)  # an earlier change may have made it sparse and huge


ENTRIES = ["link out", "link in", "loop", "fifo", "device", "missing", "folder", "empty", "sparse", "unreadable name", "other file", "long name"]


def mutate_entry(path, rng, secret, entries):
    """Puts something else in the place of a file; returns what."""
    what = rng.choice(entries)
    folder = os.path.dirname(path)
    others = [p for p in (os.path.join(folder, name) for name in sorted(os.listdir(folder))) if os.path.isfile(p) and not os.path.islink(p) and p != path]
    kept, other = read(path), read(rng.choice(others)) if others else b""
    if os.path.lexists(path) and what not in ("unreadable name", "long name"):
        os.remove(path)
    if what == "link out":
        os.symlink(secret, path)
    elif what == "link in":
        os.symlink(os.path.basename(rng.choice(others)) if others else ".", path)
    elif what == "loop":
        os.symlink(os.path.basename(path), path)
    elif what == "fifo":
        os.mkfifo(path)
    elif what == "device":
        os.symlink(rng.choice(["/dev/zero", "/dev/null", "/dev/stdin", "/proc/self/mem"]), path)
    elif what == "folder":
        os.mkdir(path)
    elif what == "empty":
        write(path, b"")
    elif what == "sparse":
        write(path, kept)
        os.truncate(path, rng.choice([1 << 24, 1 << 33, 1 << 42]))
    elif what == "other file":
        write(path, other)
    elif what == "unreadable name":
        write(os.path.join(os.fsencode(folder), b"\xff\xfe\x1b[31m.exr"), b"x")
    elif what == "long name":
        write(os.path.join(folder, "n" * 250 + ".exr"), b"x")
    return what


def mutate_file(path, rng, secret, given=False):
    """Changes one file by its kind, or what lies under its name."""
    if rng.random() < 0.25:
        return mutate_entry(path, rng, secret, ENTRIES[4:] if given else ENTRIES)
    data = read(path)
    name = path.lower()
    change = mutate_json if name.endswith((".json", ".gltf")) else mutate_exr if name.endswith(".exr") else mutate_text if name.endswith(
        (".ocio", ".comp", ".glsl", ".h", ".jsonl", ".spi1d", ".cube", ".csv")) else mutate_bytes
    write(path, change(data, rng))
    return change.__name__
