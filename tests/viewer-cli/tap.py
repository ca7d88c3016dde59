"""Runs the methods test_… of an object, and reports in TAP."""
import concurrent.futures
import fnmatch
import os
import resource
import subprocess
import sys
import traceback

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import programs  # noqa: E402

PLAIN = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "plain.json")  # a preset of few passes


def glint(*words, status=0, folder=None):
    """Runs the program, the script's first argument, which has to end with this status: `stdout` and `stderr` of what returns have what it printed."""
    run = subprocess.run([os.path.abspath(sys.argv[1]), *words], capture_output=True, text=True, cwd=folder)
    assert run.returncode == status, (words, run.returncode, run.stdout[-2000:], run.stderr[-2000:])
    return run


def explained(error):
    """The error's traceback, and the package of a program that is missing."""
    missing = isinstance(error, FileNotFoundError) and error.filename in programs.PACKAGES
    return traceback.format_exc()[:2000] + (f"{programs.Missing(error.filename)}\n" if missing else "")


def cpu_seconds():
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in used)


def failures(function, items, at_once):
    """What function(*ITEM) raised for each item, None where it raised nothing; so many run at the same time, each in a thread."""
    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        return [future.exception() for future in [pool.submit(function, *item) for item in items]]


def run(tests):
    """Whether any test failed. GLINT_TEST_ONLY, a pattern of names without test_, leaves out the others."""
    only = "test_" + os.environ.get("GLINT_TEST_ONLY", "*")
    names = [n for n in dir(tests) if fnmatch.fnmatchcase(n, only)]
    failed = 0
    print(f"1..{len(names)}", flush=True)
    for i, name in enumerate(names, 1):
        words, before = name[5:].replace("_", " "), cpu_seconds()
        try:
            getattr(tests, name)()
            print(f"ok {i} - {words}", flush=True)
        except Exception as error:
            failed += 1
            why = explained(error)
            print(f"not ok {i} - {words}\n# " + why.replace("\n", "\n# "), flush=True)
            print(f"{words}: {why}", file=sys.stderr, flush=True)  # Meson shows of a failed test what it wrote to stderr
        print(f"# {cpu_seconds() - before:.1f} s of CPU", flush=True)
    return failed > 0
