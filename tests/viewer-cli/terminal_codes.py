"""What a program sends to a terminal, as it is, and less the control sequences that are glint's own."""
import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios

OWN = re.compile(r"\x1b\[(?:[0-9;]*m|K|\?25[lh]|!p)")  # colours; to the end of the line; the cursor of a picture


def sent(words, columns=0, folder=None, **environment):
    """To a terminal of that width, or of an unknown one (0)."""
    terminal, side = pty.openpty()
    fcntl.ioctl(side, termios.TIOCSWINSZ, struct.pack("HHHH", 50 if columns else 0, columns, 0, 0))
    child = subprocess.Popen(words, stdin=side, stdout=side, stderr=side, cwd=folder, env={**os.environ, **environment})
    said, ended = b"", False
    # The program's side stays open here until all is read: what is unread when it closes may be lost.
    while True:
        if select.select([terminal], [], [], 0 if ended else 0.02)[0]:
            said += os.read(terminal, 65536)
        elif ended:
            break
        ended = child.poll() is not None
    os.close(terminal)
    os.close(side)
    return said.decode()


def without_codes(words, folder):
    return OWN.sub("", sent(words, folder=folder, TERM="xterm-256color")).replace("\r", "")
