"""What the examples for engine programmers write is valid, and lint finds nothing in it.
usage: integration.py GLINT INTEGRATION INTEGRATION_CC INTEGRATION_LIGHT (programs)"""
import os
import subprocess
import sys
import tempfile

glint, *examples = sys.argv[1:]
with tempfile.TemporaryDirectory() as folder:
    for example in examples:
        path = os.path.join(folder, os.path.basename(example) + ".exr")
        subprocess.run([example, path], check=True)
        for check in ("validate", "lint"):
            run = subprocess.run([glint, check, path], capture_output=True, text=True)
            if run.returncode:
                sys.exit(f"glint {check} {path}: {run.returncode}\n{run.stdout}{run.stderr}")
