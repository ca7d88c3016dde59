"""What a program sends to a terminal, less the control sequences that are glint's own."""
import os
import pty
import re
import select
import subprocess

OWN = re.compile(r"\x1b\[(?:[0-9;]*m|K|\?25[lh]|!p)")  # colours; to the end of the line; the cursor of a picture


def without_codes(words, folder):
    terminal, side = pty.openpty()
    child = subprocess.Popen(words, stdin=side, stdout=side, stderr=side, cwd=folder, env={**os.environ, "TERM": "xterm-256color"})
    said, ended = b"", False
    while True:
        if select.select([terminal], [], [], 0 if ended else 0.02)[0]:
            said += os.read(terminal, 65536)
        elif ended:
            break
        ended = child.poll() is not None
    os.close(terminal)
    os.close(side)
    return OWN.sub("", said.decode()).replace("\r", "")
