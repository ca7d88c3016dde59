"""Measures every step of a replay on this machine and writes the tables of BENCHMARKS.md: bench.py BUILD [--record FILE]
[--tables FILE...]. A record is JSON; records of other machines, made by the same command, become further columns."""
import argparse
import json
import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time

ROUNDS = 5
SIZE, CUBE = "1920x1080", "512"


def run(command, **more):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True, **more).stdout


def measured(command):
    """Seconds and peak memory of one whole process."""
    start = time.monotonic()
    pid = os.posix_spawnp(str(command[0]), [str(c) for c in command], os.environ,
                          file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)])
    _, status, usage = os.wait4(pid, 0)
    if status:
        sys.exit(f"bench: {' '.join(map(str, command))} failed")
    return time.monotonic() - start, usage.ru_maxrss * 1024
