"""Programs that tests run are looked for when they run: Meson may have configured before they were installed."""
import importlib.util
import os
import re
import shutil

with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "programs.h"), encoding="utf-8") as file:
    PACKAGES = dict(re.findall(r'^(?:PROGRAM|MODULE|LONG)\("(.*)", "(.*)"\)', file.read(), re.M))


# Meson fills memory that is freed with a pattern, which finds faults of ours; other programs only become slower, oiiotool tenfold.
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "MALLOC_PERTURB_"}


class Missing(Exception):
    def __init__(self, name):
        there = f": apt-get install {PACKAGES[name]}, or ./dev test, which does" if name in PACKAGES else ""
        super().__init__(f"{name} is not installed{there}")


def find(name, *others):
    """The path of the program, or of an alternative."""
    for path in map(shutil.which, (name, *others)):
        if path:
            return path
    raise Missing(name)


def module(name):
    """That Python can import the module."""
    if importlib.util.find_spec(name) is None:
        raise Missing(name)
