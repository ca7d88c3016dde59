"""What of glint's JSON does not depend on times, on what a cache held, and on what the process had done before."""
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
