"""Runs the methods test_… of an object, and says how it went in TAP."""
import traceback


def run(tests):
    """Whether any failed."""
    names = [n for n in dir(tests) if n.startswith("test_")]
    failed = 0
    print(f"1..{len(names)}", flush=True)
    for i, name in enumerate(names, 1):
        words = name[5:].replace("_", " ")
        try:
            getattr(tests, name)()
            print(f"ok {i} - {words}", flush=True)
        except Exception:
            failed += 1
            print(f"not ok {i} - {words}\n# " + traceback.format_exc()[:2000].replace("\n", "\n# "), flush=True)
    return failed > 0
