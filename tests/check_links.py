"""Every relative link of the documents leads to a file that exists and, after a #, to a heading in it. README.md and CONTRIBUTING.md
link the glossary, and each of its terms has a text with a link to the page that tells more."""
import pathlib
import re
import sys
import unicodedata

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), ROOT / "capture-format/FORMAT.md", ROOT / "passes/NOTES.md"])
GLOSSARY = ROOT / "docs/glossary.md"
LINK = re.compile(r"\]\(([^)\s]+)\)")


def prose(path):
    """The page without code, whose brackets may not be links."""
    text = re.sub(r"^```.*?^```", "", path.read_text(encoding="utf-8"), flags=re.S | re.M)
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^    .*", "", text, flags=re.M))


def anchor(heading):
    """The anchor of a heading: lower case, hyphens for spaces, no punctuation."""
    return "".join("-" if c == " " else c for c in heading.strip().lower()
                   if c in " -_" or unicodedata.category(c)[0] in "LN")


def anchors(path):
    text = re.sub(r"^```.*?^```", "", path.read_text(encoding="utf-8"), flags=re.S | re.M)
    return {anchor(h) for h in re.findall(r"^#+ (.+)$", text, re.M)}


def main():
    known, faults, count = {}, [], 0
    for page in PAGES:
        where = page.relative_to(ROOT)
        for link in LINK.findall(prose(page)):
            if re.match(r"[a-z]+:", link):
                continue
            count += 1
            name, _, heading = link.partition("#")
            target = (page.parent / name).resolve() if name else page
            if not target.exists():
                faults.append(f"{where}: {link}: there is no such file")
            elif heading and heading not in known.setdefault(target, anchors(target)):
                faults.append(f"{where}: {link}: there is no such heading")
    terms = re.split(r"^### ", GLOSSARY.read_text(encoding="utf-8"), flags=re.M)[1:]
    for term in terms:
        name, _, text = term.partition("\n")
        text = text.split("\n## ")[0]
        if not LINK.search(text) or len(text.split()) < 8:
            faults.append(f"docs/glossary.md: {name}: expected a text with a link to the page that tells more")
    for page in ("README.md", "CONTRIBUTING.md"):
        if "(docs/glossary.md" not in (ROOT / page).read_text(encoding="utf-8"):
            faults.append(f"{page} does not link docs/glossary.md")
    if count < 150 or len(terms) < 50:
        faults.append(f"only {count} links and {len(terms)} terms found, expected those of all pages")
    print("\n".join(faults), file=sys.stderr)
    return bool(faults)


sys.exit(main())
