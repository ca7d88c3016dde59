"""Every source that a declaration or a preset names is in docs/sources.md: sources.py GLINT. Speaks TAP."""
import glob
import json
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.append(os.path.join(ROOT, "tests/viewer-cli"))
import tap  # noqa: E402

GLINT = sys.argv[1]
OWN = ("glint", "chosen by")  # no document


def documents():
    """The names in the first columns of the page's tables."""
    with open(os.path.join(ROOT, "docs/sources.md"), encoding="utf-8") as page:
        rows = re.findall(r"^\| ([^|]+) \|", page.read(), re.M)
    return [r for r in rows if r not in ("short name", "document", "named as", "---")]


class Tests:
    def named(self, source, documents_):
        """A source is our own, or names one of the documents."""
        return source.startswith(OWN) or any(d in source for d in documents_)

    def test_declarations_name_documents_that_the_page_has(self):
        passes = json.loads(subprocess.run([GLINT, "passes", "--json"], capture_output=True, text=True, check=True).stdout)["passes"]
        sources = {s for p in passes for s in (p["source"], *(q["source"] for q in p["parameters"]))}
        known = documents()
        assert len(known) >= 9 and len(sources) > 50, (known, len(sources))
        unknown = [s for s in sources if not self.named(s, known)]
        assert not unknown, unknown
        assert not [s for s in sources if re.search(r"\b00\d\b", s)], "a document's private number"

    def test_presets_name_documents_that_the_page_has(self):
        for path in glob.glob(os.path.join(ROOT, "samples/presets/*.json")):
            with open(path, encoding="utf-8") as preset:
                source = json.load(preset).get("source", "glint")
            assert self.named(source, documents()), (path, source)


sys.exit(tap.run(Tests()))
