"""What the tests of the Python package share: OpenEXR's and OpenImageIO's tools as controls."""
import re
import subprocess

import numpy as np

import programs


def said(*command):
    programs.find(command[0])
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=programs.ENVIRONMENT).stdout


def raised(kinds, call, *words):
    """The error, which the call must raise with these words in its text."""
    try:
        call()
    except kinds as error:
        assert all(word in str(error) for word in words), (str(error), words)
        return error
    raise AssertionError(f"expected {kinds}, found nothing, {words}")


def dumped(path):
    """Every part's channels as oiiotool prints them: {part: {channel: array}}, with nine decimals."""
    parts, part, names, values, size = {}, "", [], [], (0, 0)
    for line in said("oiiotool", "-a", "-v", "--dumpdata", path).splitlines() + [" subimage end"]:
        if line.startswith("    Pixel ("):
            values.append(re.sub(r" \([^)]*\)", "", line.partition("): ")[2]))  # whole numbers: also as fractions, in brackets
            continue
        if values and re.match(r" ?\S", line):
            pixels = np.array(" ".join(values).split(), float).reshape(size[1], size[0], len(names))
            parts[part] = {name: pixels[:, :, i] for i, name in enumerate(names)}
            values = []
        if match := re.search(r":\s+(\d+) x\s+(\d+), \d+ channel", line):
            size = int(match[1]), int(match[2])
        elif match := re.match(r"\s*channel list: (.*)", line):
            names = [name.split(" ")[0] for name in match[1].split(", ")]
        elif match := re.match(r"\s*(?:oiio:subimagename|name): \"(.*)\"", line):
            part = match[1]
    return parts


def headers(path):
    """Parts as exrheader prints them: {name: (width, height, {channel: (bits, type)}, {attribute: text})}."""
    parts = {}
    whole = said("exrheader", path)
    for text in re.split(r"^ part \d+:$", whole, flags=re.M)[1:] or [whole]:  # a file of one part has no such line
        channels = {name: (bits, kind) for name, bits, kind in re.findall(r"^    (\S+), (\d+)-bit (\S+)", text, re.M)}
        right, bottom = re.search(r"dataWindow .*: \(0 0\) - \((\d+) (\d+)\)", text).groups()
        attributes = dict(re.findall(r"^(\S+) \(type \w+\): (.*)$", text, re.M))
        parts[attributes["name"].strip('"')] = (int(right) + 1, int(bottom) + 1, {n: (b, k.rstrip(",")) for n, (b, k) in channels.items()}, attributes)
    return parts
