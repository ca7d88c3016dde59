"""Opens a capture that was changed at random many times, and reads all of it; a process of its own, which a crash would end:
python_changed.py CAPTURE FOLDER COUNT. Prints how many were refused, and how many read."""
import os
import random
import resource
import sys

import numpy as np

import glint

capture, folder, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))  # a file that makes the reader take more than this fails the test
with open(capture, "rb") as file:
    whole = file.read()
header = whole.index(b"\0\0", whole.rindex(b"screenWindowWidth"))
refused = 0
for number in range(count):
    numbers = random.Random(number)
    data = bytearray(whole)
    kind = number % 5
    if kind == 0:  # cut off
        del data[numbers.randrange(len(data)):]
    elif kind == 1:  # another size, which the rest of the file does not have
        at = -1
        for _ in range(numbers.randrange(1, 20)):
            at = data.find(b"dataWindow\0box2i\0", at + 1)
        if at >= 0:
            data[at + 21:at + 37] = np.array([0, 0, *(numbers.choice([0, 7, 40000, 2 ** 31 - 1, -5]) for _ in range(2))], "<i4").tobytes()
    else:  # bytes of the header, of the pixels, or of both
        for _ in range(numbers.choice([1, 3, 20])):
            data[numbers.randrange(header if kind < 4 else len(data))] = numbers.choice([0, 1, 0x7f, 0x80, 0xff, numbers.randrange(256)])
    path = os.path.join(folder, "changed.exr")
    with open(path, "wb") as file:
        file.write(data)
    try:
        with glint.open(path, array_bytes=1 << 28) as opened:
            for part in opened.parts.values():
                for channel in part.channels:
                    part.read_raw(channel)
                    part.read(channel)
                part.attributes, part.cubemap, part.planar, part.sky, part.probe, repr(part)
            glint.validate(path)
    except glint.Error:
        refused += 1
print(refused, count - refused)
