"""The page of glint live by the keyboard alone, its contrast, and in a narrow window: live_keys.py GLINT. Speaks TAP."""
import sys

import live_tab
from live_tab import STORE, row

CONTRAST = 4.5  # WCAG AA for text of this size


class Tests(live_tab.Tests):
    def test_the_keyboard_alone(self):
        tab, number = self.reset(), self.integer()
        tab.letter("/")
        assert self.ask("document.activeElement.id") == "search"
        tab.browser.call("Input.insertText", text=number["name"].split(".")[1])
        for _ in range(40):
            tab.press("Tab", 9)
            if self.ask(f"document.activeElement === {row(number['name'])}.querySelector('input[type=range]')"):
                break
        assert self.ask("getComputedStyle(document.activeElement).outlineStyle") != "none"
        assert number["help"] in self.ask("document.querySelector('.strip').textContent")
        before = tab.state()
        for key, code in (("ArrowRight", 39), ("ArrowRight", 39), ("ArrowLeft", 37)):
            tab.press(key, code)
        self.until(f"{STORE}.result.state.set['{number['name']}'] !== undefined")
        self.idle()
        tab.letter("p")
        self.until(f"{STORE}.pinned")
        tab.press("z", 90, modifiers=2)
        self.idle()
        assert tab.shown() == before
        tab.letter("x")
        self.until(f"{STORE}.result.state.set['{number['name']}'] !== undefined")
        tab.letter("u")
        self.until(f"!{STORE}.pinned")
        tab.press("?", 0, text="?")
        assert self.ask("document.querySelector('dialog.help-keys').open") and self.ask("document.querySelectorAll('dialog kbd').length") > 15
        tab.press("Escape", 27)
        assert not self.ask("document.querySelector('dialog.help-keys').open")
        for key, panel in zip("12345", ("pipeline", "picture", "pixel", "figures", "out")):
            tab.letter(key)
            assert self.ask("document.activeElement.closest('.panel').id") == panel, (key, self.ask("document.activeElement.outerHTML.slice(0, 80)"))
        # in the picture arrow keys and Enter choose a pixel at once; the heat map is a key away where there is a B
        tab.letter("2")
        tab.press("ArrowRight", 39)
        tab.press("Enter", 13)
        self.until(f"{STORE}.look.x !== null")
        tab.letter("h")
        assert self.ask(f"{STORE}.look.mode") != "alone0"
        tab.letter("p")
        self.until(f"{STORE}.pinned")
        tab.letter("h")
        self.until("[...document.querySelectorAll('.stage .bar button')].some(b => b.textContent === 'Heat map' && b.getAttribute('aria-pressed') === 'true')")
        tab.letter("h")
        self.until("[...document.querySelectorAll('.stage .bar button')].some(b => b.dataset.mode === 'slider' && b.getAttribute('aria-pressed') === 'true')")
        tab.quiet()

    def test_tab_reaches_everything_and_its_focus_is_seen(self):
        self.reset()
        self.ask("document.querySelectorAll('.slot .fold')[3].click(), document.activeElement.blur()")
        self.tab.browser.settle()
        wanted = self.ask("""(window.wanted = [...document.querySelectorAll('button, input, select, summary, [tabindex="0"]')].filter(e =>
            e.checkVisibility({visibilityProperty: true, contentVisibilityAuto: true}) && !e.disabled && e.tabIndex >= 0)).length""")
        assert wanted > 60
        skipped = self.ask("[...document.querySelectorAll('button, input, select, summary')].filter(e => e.tabIndex < 0 && !e.disabled && !e.matches('.slot .title')).map(e => e.outerHTML.slice(0, 120))")
        assert not skipped, skipped  # a slot's title does what the button before it does
        self.ask("window.reached = new Set(), window.unseen = [], document.addEventListener('focusin', e => { reached.add(e.target); if (getComputedStyle(e.target).outlineStyle === 'none') unseen.push(e.target.outerHTML.slice(0, 120)); }); 1")
        for _ in range(wanted + 10):
            self.tab.press("Tab", 9)
        missed = self.ask("wanted.filter(e => e.isConnected && !reached.has(e)).map(e => e.outerHTML.slice(0, 120))")
        assert not missed, missed
        assert not self.ask("unseen"), self.ask("unseen")
        nameless = self.ask("""wanted.filter(e => !(e.getAttribute('aria-label') || e.textContent.trim() || e.labels?.length || e.title)).map(e => e.outerHTML.slice(0, 120))""")
        assert not nameless, nameless

    def test_contrast_is_enough_in_light_and_dark(self):
        self.reset()
        number = self.integer()
        self.ask("document.querySelectorAll('.slot .fold')[3].click()")
        self.tab.write(row(number["name"]) + ".querySelector('.exact')", "-1000")
        self.until(f"{STORE}.refusal")
        self.ask(f"{STORE}.notice('a notice'), document.querySelector('.missing').open = true, {STORE}.change(s => {{ s.set['{number['name']}'] = {int(number['lowest'])}; }}, {{}})")
        self.idle()
        self.ask("document.activeElement.blur()")  # in a field letters are text
        for look in ("light", "dark"):
            if self.ask("document.documentElement.dataset.look") != look:
                self.tab.letter("d")
            self.tab.browser.settle()
            weak = self.ask("""(() => {
                const parse = c => { const m = c.match(/[\\d.]+/g).map(Number); return [m[0], m[1], m[2], m[3] === undefined ? 1 : m[3]]; };
                const part = v => { v /= 255; return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; };
                const light = c => 0.2126 * part(c[0]) + 0.7152 * part(c[1]) + 0.0722 * part(c[2]);
                const ground = e => { for (; e; e = e.parentElement) { const c = parse(getComputedStyle(e).backgroundColor); if (c[3] > 0.99) return c; } return [255, 255, 255, 1]; };
                const weak = [];
                for (const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT); walk.nextNode();) {
                    const e = walk.currentNode.parentElement;
                    if (!walk.currentNode.data.trim() || !e.checkVisibility({visibilityProperty: true}) || e.closest(':disabled, svg, option, .frame, script')) continue;
                    const a = light(parse(getComputedStyle(e).color)), b = light(ground(e)), ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
                    if (ratio < %s) weak.push([ratio.toFixed(2), e.className, walk.currentNode.data.slice(0, 40)]);
                }
                return weak;
            })()""" % CONTRAST)
            assert not weak, (look, weak[:10])
        assert self.ask("getComputedStyle(document.body).backgroundColor") != "rgb(255, 255, 255)"

    def test_a_narrow_window_is_usable(self):
        self.reset()
        size = lambda w, h: self.tab.browser.call("Emulation.setDeviceMetricsOverride", width=w, height=h, deviceScaleFactor=1, mobile=False)
        try:
            size(400, 800)
            self.tab.browser.settle()
            self.ask("document.querySelectorAll('.slot .fold')[3].click()")
            self.tab.browser.settle()
            assert self.ask("document.documentElement.scrollWidth") <= 402
            outside = self.ask("[...document.querySelectorAll('button, input, select')].filter(e => e.offsetParent && !e.closest('.scroll, .stage-scroll')).map(e => [e.outerHTML.slice(0, 90), e.getBoundingClientRect()]).filter(([, r]) => r.left < -1 || r.right > 402).map(([t]) => t)")
            assert not outside, outside
        finally:
            self.tab.browser.call("Emulation.clearDeviceMetricsOverride")


sys.exit(live_tab.run(Tests))
