"""The page of glint live while the device is lost, while a shader does not compile, and afterwards: live_lost.py GLINT PASSES LAYERS.

LAYERS: the folder of the Vulkan layer that loses devices (tests/replay/fault_layer.c)."""
import os
import sys
import tempfile

import tap
from browser import Browser
from live_tab import STORE, Server, Tab, row

GLINT, PASSES, LAYERS = sys.argv[1:]
ALERT = "[...document.querySelectorAll('[role=alert]')].filter(e => e.offsetParent).map(e => e.textContent).join(' ')"
PICTURE = """(c => { let sum = 7; const copy = new OffscreenCanvas(c.width, c.height).getContext('2d');
    copy.drawImage(c, 0, 0); for (const v of copy.getImageData(0, 0, c.width, c.height).data) sum = (31 * sum + v) | 0;
    return `${c.width} ${sum}`; })(document.querySelector('.live-picture canvas'))"""


class Tests:
    """Each with a browser of its own, in which no page of another server is left."""

    def __init__(self, folder):
        self.folder = folder
        self.capture, self.lost = os.path.join(folder, "street.exr"), os.path.join(folder, "lost")
        tap.glint("sample", "street", "--light=1", "-o", self.capture, "--size", "96x54", "--cube-size", "16")
        os.environ.update(VK_LAYER_PATH=LAYERS, VK_INSTANCE_LAYERS="VK_LAYER_GLINT_fault", GLINT_FAULT_FILE=self.lost)

    def value(self, tab, name, value):
        tab.write(row(name) + ".querySelector('.exact')", str(value))

    def test_a_lost_device(self):
        with Server(self.capture) as server, Browser(1440, 900) as browser:
            tab = Tab(browser, server)
            tab.open()
            before = tab.until(PICTURE)
            with open(self.lost, "w"):
                pass
            self.value(tab, "compose.intensity", 3)
            tab.until(f"{ALERT}.includes('the device was lost')")
            assert tab.ask(PICTURE) == before and "street.exr" in tab.ask(ALERT), tab.ask(ALERT)
            self.value(tab, "compose.intensity", 4)
            tab.until(f"{ALERT}.includes('creating the device')")
            assert tab.ask(PICTURE) == before and tab.state()["set"] == {"compose.intensity": 4}
            os.remove(self.lost)
            self.value(tab, "compose.intensity", 5)
            tab.until(f"{STORE}.result.state.set['compose.intensity'] === 5")
            tab.idle()
            assert not tab.ask(ALERT) and tab.until(f"{PICTURE} !== '{before}'")
            tab.quiet()

    def test_a_shader_that_does_not_compile(self):
        shader = os.path.join(self.folder, "own.comp")
        with open(os.path.join(PASSES, "picture/compose/brdf.comp"), encoding="utf-8") as file:
            text = file.read()

        def save(changed):
            with open(shader, "w", encoding="utf-8") as file:
                file.write(changed)

        save(text)
        if os.path.exists(self.lost):
            os.remove(self.lost)
        with Server(self.capture, "--shader", f"compose={shader}") as server, Browser(1440, 900) as browser:
            tab = Tab(browser, server)
            tab.open()
            before = tab.until(PICTURE)
            save(text.replace("void main() {", "void main() {\n    no such thing;", 1))
            tab.until(f"{ALERT}.includes('own.comp:')")  # the page asks again when the file changes
            assert tab.ask(PICTURE) == before
            save(text.replace("void main() {", "void main() {\n", 1))
            tab.until(f"!{ALERT}")
            tab.idle()
            assert tab.ask(PICTURE) == before
            tab.quiet()


with tempfile.TemporaryDirectory() as work:
    sys.exit(tap.run(Tests(work)))
