"""Dumps a frame of a Blender file as a capture of glint: blender -b FILE.blend -P run.py -- -o F.exr [options]; -- --help lists them."""
import os
import sys
import traceback

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from glint_capture import dump  # noqa: E402

try:
    status = dump.main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else ["--help"])
except Exception:  # Blender itself would end with 0
    traceback.print_exc()
    status = 1
sys.stdout.flush()
os._exit(status)
