"""What of glint's JSON does not depend on times, on what a cache held, and on what the process had done before."""
import json
import os
import re

TIMES = re.compile("(_ns|_ms|ms|seconds|_bytes)$|^(ms|time|cold|min|median|max|low|high)$")
CACHED = re.compile("^(ran|cached|reason|dispatches|work|history|executed)$")


def without_times(value, timed=False):
    """Numbers of times become the word time; what of them is there stays."""
    if isinstance(value, dict):
        return {k: without_times(v, timed or bool(TIMES.search(k))) for k, v in value.items() if not CACHED.search(k)}
    if isinstance(value, list):
        return [without_times(v, timed) for v in value]
    return "time" if timed and not isinstance(value, str) else value


def contents(folder, *left_out):
    """{PATH: contents} of a folder, without times, and without these files and folders of its own."""
    found = {}
    for root, folders, files in os.walk(folder):
        if root == folder:
            folders[:] = [name for name in folders if name not in left_out]
            files = [name for name in files if name not in left_out]
        for name in files:
            path = os.path.join(root, name)
            with open(path, "rb") as file:
                data = file.read()
            if name.endswith(".json"):
                data = without_times(json.loads(data))
            elif name.endswith(".jsonl"):
                data = [without_times(json.loads(line)) for line in data.splitlines()]
            found[os.path.relpath(path, folder)] = data
    return found
