"""What docs/live.md says of requests and answers, read from its text: members of bodies, and shapes of answers.

A shape is a dict of members, a list of one shape, None for any value, or a tuple of shapes of which one has to fit."""
import pathlib
import re

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs/live.md"
ELLIPSIS = "…"


def parse(text):
    """The shape of JSON as the page writes it: {"name", "size": [w, h], "of": [{"run"}, …]}, with words for values."""
    tokens = re.findall(r'"[^"]*"|[{}\[\],:]|[^\s{}\[\],:"]+', text)

    def one():
        token = tokens.pop(0)
        if token == "{":
            members = {}
            while tokens[0] != "}":
                name = tokens.pop(0)
                if name != ELLIPSIS:
                    members[name.strip('"')] = tokens.pop(0) and value() if tokens[0] == ":" else None
                if tokens[0] == ",":
                    tokens.pop(0)
            tokens.pop(0)
            return members
        if token == "[":
            shapes = []
            while tokens[0] != "]":
                if tokens[0] in (",", ELLIPSIS):
                    tokens.pop(0)
                else:
                    shapes.append(value())
            tokens.pop(0)
            return [next((s for s in shapes if s is not None), None)]
        return None

    def value():
        shapes = [one()]
        while tokens and tokens[0] not in (",", "]", "}"):
            if tokens[0] == "or":
                tokens.pop(0)
            shapes.append(one())
        shapes = [s for s in shapes if s is not None]
        return tuple(shapes) if len(shapes) > 1 else shapes[0] if shapes else None

    return value()


def spans(text):
    return re.findall(r"`([^`]+)`", text)


def rows(section):
    """The members of the section's table."""
    members = {}
    for names, about in re.findall(r"^\| (`[^|]*) \| (.*) \|$", section, re.M):
        shapes = [parse(s) for s in spans(about)[:1] if s[0] in "[{" and about.startswith("`")]
        if not shapes and (found := re.match(r"[^`:.]*: `([\[{].*?)`", about)):
            shapes = [parse(found[1])]
        for i, name in enumerate(spans(names)):
            members[name] = shapes[0] if shapes and i == 0 else None
    return members


class Request:
    def __init__(self, method, path, section):
        self.method, self.path, self.name = method, path, path.split("?")[0].rsplit("/", 1)[1]
        before = section.split("Answer:")[0]
        bodies = [s for s in spans(before) if s.startswith("{")]
        self.body = list(parse(bodies[0])) if bodies and method == "POST" else []
        self.query = re.findall(r"[?&](\w+)=", path)
        if more := re.search(r"Further values: (.*?)\n\n", section + "\n\n", re.S):
            self.query += re.findall(r"(?:^|, |and )`([a-z]+)`", re.sub(r" \([^)]*\)|: .*", "", more[1].replace("\n", " ")))
        self.answer = rows(section)
        if not self.answer and (given := re.search(r"Answer: `(\{.*?\})`", section, re.S)):
            self.answer = parse(given[1])


def requests():
    """The requests of the page by their names, with `run` complete."""
    text = PAGE.read_text(encoding="utf-8").split("## Requests")[1]
    found = {}
    for method, path, section in re.findall(r"^### `(\w+) (/api/v1/[^`]+)`\n(.*?)(?=^### |\Z)", text, re.M | re.S):
        request = Request(method, path, section)
        found[request.name] = request
    found["run"].answer = {**found["pipeline"].answer, **found["run"].answer}
    return found


def raw_head():
    """The members of the JSON before the pixels of a raw picture."""
    section = PAGE.read_text(encoding="utf-8").split("### `GET /api/v1/picture")[1]
    return parse(re.search(r"`(\{.*?\})`", section, re.S)[1])


def state_members():
    text = PAGE.read_text(encoding="utf-8")
    return list(parse(re.sub(r"\s{3,}.*", "", re.search(r"```\n(\{\"capture\".*?)```", text, re.S)[1], flags=re.M)))


def differences(shape, value, at="answer"):
    """What a value lacks of its shape, and what it has beyond it."""
    if shape is None:
        return []
    if isinstance(shape, tuple):
        tries = [differences(s, value, at) for s in shape]
        return min(tries, key=len)
    if isinstance(shape, list):
        if not isinstance(value, list):
            return [f"{at}: no array"]
        return [d for i, v in enumerate(value[:40]) for d in differences(shape[0], v, f"{at}[{i}]")]
    if not isinstance(value, dict):
        return [f"{at}: no object"]
    found = [f"{at}: lacks {name}" for name in shape if name not in value] + [f"{at}: has {name}, which is not documented" for name in value if name not in shape]
    return found + [d for name in shape if name in value for d in differences(shape[name], value[name], f"{at}.{name}")]
