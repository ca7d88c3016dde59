"""The pictures of README.md that show the program itself: a run's images, what a terminal shows, run in tmux, a page and a pixel's
drawing in headless Chromium.

pictures.py GLINT [FOLDER]: writes street.png, street-passes.png, terminal-view.png, terminal-diff.png, page-diff.jpg and
probe.png, by default to docs/."""
import html
import json
import os
import re
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../tests/viewer-cli"))
from browser import Browser  # noqa: E402

NAMED = ["#1d1f21", "#cc6666", "#b5bd68", "#f0c674", "#81a2be", "#b294bb", "#8abeb7", "#c5c8c6"]
NAMED += ["#666666", "#d54e53", "#b9ca4a", "#e7c547", "#7aa6da", "#c397d8", "#70c0b1", "#eaeaea"]


def numbered(n):
    if n < 16:
        return NAMED[n]
    if n >= 232:
        return "#" + 3 * f"{8 + 10 * (n - 232):02x}"
    n -= 16
    return "#" + "".join(f"{v * 40 + 55 if v else 0:02x}" for v in (n // 36, n // 6 % 6, n % 6))


class Style:
    """The style that an escape sequence of colours sets."""

    def __init__(self):
        self.reset()

    def reset(self):
        self.fore, self.back, self.bold, self.swapped = None, None, False, False

    def take(self, codes):
        codes = [int(c or 0) for c in re.split("[;:]", codes)] or [0]
        while codes:
            code = codes.pop(0)
            if code in (38, 48):
                if codes.pop(0) == 2:
                    colour, codes = "#%02x%02x%02x" % tuple(codes[:3]), codes[3:]
                else:
                    colour = numbered(codes.pop(0))
                self.fore, self.back = (colour, self.back) if code == 38 else (self.fore, colour)
            elif code == 0:
                self.reset()
            elif code in (1, 22):
                self.bold = code == 1
            elif code in (7, 27):
                self.swapped = code == 7
            elif 30 <= code <= 37 or 90 <= code <= 97:
                self.fore = NAMED[code - 30 if code < 90 else code - 82]
            elif 40 <= code <= 47 or 100 <= code <= 107:
                self.back = NAMED[code - 40 if code < 100 else code - 92]
            elif code in (39, 49):
                self.fore, self.back = (None, self.back) if code == 39 else (self.fore, None)

    def css(self):
        fore, back = self.fore or "#d6d9de", self.back or "transparent"
        if self.swapped:
            fore, back = self.back or "#16181d", self.fore or "#d6d9de"
        return f"color:{fore};background:{back}" + (";font-weight:bold" if self.bold else "")


def to_html(screen, title):
    """The screen that tmux captured, cell by cell, so that blocks touch for any width of the font's glyphs."""
    style, rows = Style(), []
    for line in screen.rstrip().splitlines():
        cells = []
        for escape, character in re.findall(r"\x1b\[([\d;:]*)m|(.)", line):
            if character:
                cells.append(f"<i style=\"{style.css()}\">{html.escape(character)}</i>")
            else:
                style.take(escape)
        rows.append("<div>" + "".join(cells) + "</div>")
    return f"""<!doctype html><meta charset="utf-8"><style>body {{ margin: 0; background: #16181d; }}
main {{ display: inline-block; padding: 8px 14px 14px; font: 13px/16px "DejaVu Sans Mono", monospace; }}
h1 {{ font: 12px/18px "DejaVu Sans", sans-serif; color: #8b949e; text-align: center; margin: 0 0 6px; }}
div {{ height: 16px; white-space: pre; }} i {{ font-style: normal; display: inline-block; width: 8px; height: 16px; overflow: hidden; vertical-align: top; }}
</style><main><h1>{html.escape(title)}</h1>{"".join(rows)}</main>"""


def terminal(folder, path, columns, lines, *commands):
    """Types commands into a new tmux, and returns its screen with colours."""
    socket = os.path.join(folder, "tmux")

    def tmux(*words):
        return subprocess.run(["tmux", "-S", socket, *words], check=True, capture_output=True, text=True).stdout

    env = {**os.environ, "PS1": "$ ", "PATH": f"{path}:{os.environ['PATH']}", "COLORTERM": "truecolor"}
    subprocess.run(["tmux", "-S", socket, "-f", "/dev/null", "new-session", "-d", "-x", str(columns), "-y", str(lines), "-c", folder,
                    "env", "PS1=$ ", "COLORTERM=truecolor", "bash", "--norc", "--noprofile"], check=True, env=env)
    try:
        for command in commands:
            tmux("send-keys", "-l", command)
            tmux("send-keys", "Enter")
            time.sleep(0.5)  # for the command to begin; it has ended when the prompt is back
            while tmux("display-message", "-p", "#{pane_current_command}").strip() != "bash" or not tmux("capture-pane", "-p").rstrip().endswith("$"):
                time.sleep(0.2)
        return tmux("capture-pane", "-e", "-p")
    finally:
        tmux("kill-server")


def main():
    glint = os.path.abspath(sys.argv[1])
    docs = os.path.abspath(sys.argv[2] if len(sys.argv) > 2 else os.path.join(HERE, "../docs"))
    path = os.path.dirname(glint)
    with tempfile.TemporaryDirectory() as folder, Browser(1240, 1010) as browser:
        def call(*words):
            subprocess.run([glint, *words], cwd=folder, check=True, capture_output=True)

        call("sample", "street", "-o", "street.exr", "--size", "960x540", "--truth", "1")
        call("replay", "street.exr", "-o", "run", "--diagnostics")
        call("replay", "street.exr", "-o", "run2", "--diagnostics", "--set", "cubemap_trace.steps_hq=4")
        call("view", "run", "--no-legend", "-o", os.path.join(docs, "street.png"))
        call("view", "run", "--sheet", "--image", "normal_jittered,screen_end,cubemap_end,travelled,cubemap_index,reflection",
             "-o", os.path.join(docs, "street-passes.png"))
        # The screen image shows nothing behind a car: the cube map continues the ray.
        call("probe", "street.exr", "662,280", "-o", "ray.svg")
        browser.open(os.path.join(folder, "ray.svg"))
        browser.picture(os.path.join(docs, "probe.png"), *browser.evaluate("['width', 'height'].map(k => document.documentElement[k].baseVal.value)"))
        for name, lines, command in (("terminal-view", 40, "glint view run"), ("terminal-diff", 26, "glint diff run run2")):
            screen = terminal(folder, path, 118, lines, "clear", command)
            with open(os.path.join(folder, "screen.html"), "w", encoding="utf-8") as file:
                file.write(to_html(screen, "tmux"))
            browser.open(os.path.join(folder, "screen.html"))
            box = browser.evaluate("(r => [r.width, r.height])(document.querySelector('main').getBoundingClientRect())")
            browser.picture(os.path.join(docs, f"{name}.png"), *box)
        report = json.loads(subprocess.run([glint, "diff", "run", "run2", "--html", "diff.html", "--json"], cwd=folder, capture_output=True, check=False).stdout)
        image = next(i for i in report["images"] if i["name"] == "composed")
        most = [(image["largest"][k] + 0.5) / image[size] for k, size in (("x", "width"), ("y", "height"))]
        browser.look(dark=True)
        browser.show(os.path.join(folder, "diff.html"))
        browser.evaluate("[...document.querySelectorAll('main > section')].find(s => s.querySelector('.stage')).scrollIntoView()")
        x, y, width, height = browser.evaluate("(r => [r.x, r.y, r.width, r.height])(document.querySelector('.frame').getBoundingClientRect())")
        browser.click(x + most[0] * width + 60, y + 0.5 * height)
        browser.point_at(x + most[0] * width, y + most[1] * height)
        browser.evaluate("new Promise(done => setTimeout(done, 300))")
        browser.picture(os.path.join(docs, "page-diff.jpg"), 1240, 1010)


if __name__ == "__main__":
    main()
