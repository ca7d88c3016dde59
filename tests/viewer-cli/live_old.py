"""The page of glint live shows nothing old as new, whatever order answers come in, and leaves the focus where it was: live_old.py GLINT. Speaks TAP."""
import json
import os
import sys
import time

import live_tab
from live_tab import STORE, Server, button, row

HOLD = """
window.held = [], window.holds = () => false, window.urls = {made: 0, gone: 0};
if (!window.fetchOf) {
    window.fetchOf = fetch;
    window.fetch = async (path, options) => {
        if (holds(String(path), options)) await new Promise(done => held.push(done));
        return fetchOf(path, options);
    };
    const {createObjectURL: make, revokeObjectURL: revoke} = URL;
    URL.createObjectURL = blob => { urls.made++; return make.call(URL, blob); };
    URL.revokeObjectURL = url => { urls.gone++; revoke.call(URL, url); };
}
window.release = () => { holds = () => false; held.splice(0).forEach(f => f()); };
1
"""
LAYERS = "[...document.querySelectorAll('.live-picture .frame canvas')].filter(e => !e.hidden).length"
SAID = "[...document.querySelectorAll('.notes .message')].filter(e => e.offsetParent).map(e => e.textContent).join(' ')"


class Tests(live_tab.Tests):
    def reset(self):
        tab = super().reset()
        self.ask(HOLD)
        return tab

    def change(self, name, value):
        self.ask(f"{STORE}.change(s => {{ s.set['{name}'] = {value}; }})")

    def fragment(self, link):
        return self.ask(f"'#s=' + btoa(JSON.stringify({json.dumps(link)})).replace(/\\+/g, '-').replace(/\\//g, '_').replace(/=+$/, '')")

    def mode(self, text):
        choice = button(text, "document.querySelector('.stage .bar')")
        self.until(choice)
        self.ask(f"{choice}.click()")

    def test_a_link_that_does_not_fit_is_refused_where_the_page_is(self):
        tab = self.reset()
        before = tab.state()
        for given in ({"use": 5, "set": "x", "skip": 3}, {"capture": 99}, {"preset": "none such"}, {"set": None}, {"use": {"none": "such"}}):
            self.ask(f"document.querySelectorAll('.news .close').forEach(b => b.click()), location.hash = '{self.fragment({'state': given, 'look': {'exposure': 3}})}'; 1")
            self.until(f"{SAID}.includes('cannot be shown')")
            self.idle()
            assert tab.state() == before and self.ask(f"{STORE}.look.exposure") == 0, given
        # what a look lacks or has of another kind is as at first
        self.ask(f"location.hash = '{self.fragment({'state': {}, 'look': {'exposure': 'abc', 'zoom': 'abc', 'low': '1', 'x': '5', 'y': 1.5, 'mode': 7, 'image': 3, 'high': 9}})}'; 1")
        self.until(f"{STORE}.look.high === 9")
        look = self.ask(f"{STORE}.look")
        assert [look[k] for k in ("exposure", "zoom", "low", "x", "y", "mode", "image")] == [0, 0, None, None, None, None, None], look
        # B, in place and at the start
        for b in ({"state": {"preset": "none such"}}, {"state": {"skip": 3}, "title": "b"}, {"of": "truth", "effect": "none such"}):
            self.ask(f"document.querySelectorAll('.news .close').forEach(b => b.click()), location.hash = '{self.fragment({'state': {}, 'b': b})}'; 1")
            self.until(f"{SAID}.length > 0")
            tab.open(self.fragment({"state": {}, "b": b}))
            self.until(f"{SAID}.length > 0")
            assert not self.ask(f"{STORE}.pinned")
            tab.quiet()
        self.ask(f"location.hash = '{self.fragment({'state': {}, 'b': {'state': {}, 'title': 'of the link'}})}'; 1")
        self.until(f"{STORE}.pinned?.title === 'of the link'")
        tab.quiet()

    def test_an_address_opened_in_the_same_tab_is_taken(self):
        tab = self.reset()
        self.ask(f"location.hash = '{self.server.token}'; 1")
        self.until("location.hash === ''")
        self.idle()
        self.ask("window.same = 1, sessionStorage.clear(), location.hash = 'a' + '0'.repeat(63); 1")
        self.until("document.documentElement.dataset.ready === 'token' && !window.same")
        self.ask(f"location.hash = '{self.server.token}'; 1")
        self.idle()
        assert self.server.token not in self.ask("location.href")
        # a page that was refused later begins anew, so that nothing of it listens on
        self.ask("window.same = 1, glintLive.api.setToken('b'.repeat(64)), glintLive.api.get('/api/v1/registry').catch(() => 0)")
        self.until("document.documentElement.dataset.ready === 'token'")
        self.ask(f"document.querySelector('#token').value = '{self.server.token}', document.querySelector('form.token button').click()")
        self.until("!window.same")
        self.idle()

    def test_the_last_thing_pinned_is_b(self):
        self.reset()
        presets = [p["name"] for p in self.registry["presets"] if p["name"] != self.registry["start"]["preset"]][:2]
        pin = lambda name: self.ask(f"{STORE}.pinState({{capture: 0, preset: '{name}', use: {{}}, set: {{}}, skip: [], force: []}}, '{name}'), 1")
        self.ask(f"holds = (path, options) => path.endsWith('/run') && JSON.parse(options.body).state.preset === '{presets[0]}', 1")
        pin(presets[0])
        pin(presets[1])
        self.until(f"{STORE}.pinned?.title === '{presets[1]}' && held.length === 1")
        self.ask("release()")
        time.sleep(0.5)
        assert self.ask(f"{STORE}.pinned.title") == presets[1]
        # nor does what was unpinned come back
        self.ask("holds = path => path.endsWith('/run'), 1")
        pin(presets[0])
        self.until("held.length === 1")
        self.ask(f"{STORE}.unpin(), release()")
        time.sleep(0.5)
        assert not self.ask(f"{STORE}.pinned")
        # a run of slower programs is not pinned as the frame
        self.ask(f"window.kept = {STORE}.result, {STORE}.result = {{...kept, quick: true, run: 'quick'}}, {STORE}.pinState({STORE}.state), 1")
        self.until(f"{STORE}.pinned")
        assert self.ask(f"{STORE}.pinned.result.run") != "quick"

    def test_a_heat_map_is_of_the_runs_that_are_shown(self):
        tab, number = self.reset(), self.integer()
        heat = "document.querySelector('.frame.alone0') && [...document.querySelectorAll('.live-picture .frame canvas')].filter(e => !e.hidden).length"
        tab.letter("p")
        self.until(f"{STORE}.pinned")
        self.mode("Heat map")
        self.until(f"{heat} === 1")
        self.mode("Slider")
        self.change(number["name"], int(number["lowest"]) + 2)
        self.idle()
        self.ask("holds = path => path.includes('/difference'), 1")
        self.mode("Heat map")
        tab.browser.settle()
        assert self.ask(f"{heat}") == 0
        self.ask("release()")
        self.until(f"{heat} === 1")
        # another B: what was shown of the one before goes at once
        self.ask("holds = path => path.includes('/difference') || path.includes('/picture'), 1")
        self.ask(f"{STORE}.pinState({{...{STORE}.state, set: {{'{number['name']}': {int(number['lowest']) + 7}}}}}, 'another'), 1")
        self.until(f"{STORE}.pinned.title === 'another'")
        tab.browser.settle()
        assert self.ask(f"{heat}") == 0
        self.mode("B: another")
        tab.browser.settle()
        assert self.ask(LAYERS) == 0
        self.ask("release()")
        self.until(f"{LAYERS} === 1")
        tab.quiet()

    def test_the_draft_is_marked_as_long_as_it_is_seen(self):
        self.reset()
        self.ask(f"fetchOf('/api/v1/run', {{method: 'POST', headers: {{Authorization: 'Bearer {self.server.token}'}}, body: JSON.stringify({{state: {STORE}.state, draft: true}})}}).then(r => r.json()).then(r => {{ window.whole = {STORE}.result; {STORE}.result = r; {STORE}.emit('result'); }})")
        self.until("document.querySelector('.live-over .draft').textContent.startsWith('Draft')")
        self.ask(f"holds = path => path.includes('/picture'), {STORE}.result = whole, {STORE}.emit('result'), 1")
        self.until("held.length")
        assert self.ask("!document.querySelector('.live-over .draft').hidden")
        self.ask("release()")
        self.until("document.querySelector('.live-over .draft').hidden")

    def test_times_are_compared_with_times_of_the_same_kind(self):
        tab, number = self.reset(), self.integer()
        time_of = lambda: self.ask("(r => [r.querySelector('.unit').textContent.trim(), ...[...r.cells].slice(1).map(c => c.textContent)])([...document.querySelectorAll('.figures tbody tr')].find(r => r.textContent.startsWith('time of a frame')))")
        tab.letter("m")
        self.until(f"document.querySelector('.figures .unit')?.textContent.includes('median') && !{STORE}.besides.length")
        # B has been replayed once, and is not compared with a median
        self.ask("holds = path => path.includes('/figures'), 1")
        self.ask(f"{STORE}.pinState({{...{STORE}.state, set: {{'{number['name']}': {int(number['lowest']) + 7}}}}}, 'b'), 1")
        self.until(f"{STORE}.pinned && held.length")
        unit, a, b, change = time_of()
        assert "median" in unit and b == "\u2013" and change == "", (unit, a, b, change)
        self.ask("release()")
        self.until(f"!{STORE}.besides.length")
        # nor is what programs that read parameters from memory took
        self.ask(f"{STORE}.unpin(), {STORE}.result = {{...{STORE}.result, quick: true, run: 'other', state: {{...{STORE}.state, skip: ['none such']}}}}, {STORE}.emit('result'), 1")
        assert time_of()[1] == "\u2013", time_of()

    def test_figures_are_of_the_files_and_the_metric(self):
        tab = self.reset()
        tab.letter("m")
        self.until(f"document.querySelector('.tried .plot svg') && !{STORE}.besides.length")
        self.ask("document.querySelectorAll('.figures-panel label input[type=checkbox]').forEach(b => b.checked && b.click()), 1")
        metric = "document.querySelector('.figures-panel select[aria-label=metric]')"
        self.ask(f"{metric}.selectedIndex += 1, {metric}.dispatchEvent(new Event('change')), 1")
        tab.browser.settle()
        assert self.ask("!document.querySelector('.tried .plot')?.offsetParent")  # nothing was tried by it
        self.ask(f"{metric}.selectedIndex -= 1, {metric}.dispatchEvent(new Event('change')), 1")
        self.until(f"document.querySelector('.tried .plot')?.offsetParent && !{STORE}.besides.length")
        self.ask(f"{STORE}.emit('files'), 1")
        tab.browser.settle()
        assert self.ask("!document.querySelector('.tried .plot')?.offsetParent") and "Not measured" in self.ask("document.querySelector('.figures-panel > [role=status]').textContent")
        # what failed is said as long as it is of what is shown
        self.ask("window.post = glintLive.api.insist, glintLive.api.insist = async (path, ...rest) => { if (path.endsWith('/figures')) throw glintLive.api.failure('no such luck', 'device', 500); return post(path, ...rest); }, 1")
        said = "document.querySelector('.figures-panel > [role=status]').textContent"
        tab.letter("m")
        self.until(f"{said} === 'no such luck'")
        self.change(self.integer()["name"], 9)
        self.idle()
        assert self.ask(said) != "no such luck"
        self.ask("glintLive.api.insist = post, 1")

    def test_a_point_of_a_long_name_goes_back_to_its_own_state(self):
        tab = self.reset()
        numbers = [p["name"] for p in self.parameters().values() if p["type"] == "int"][:4]
        for k in range(2):
            self.ask(f"{STORE}.change(s => {{ {json.dumps(numbers)}.forEach((n, i) => {{ s.set[n] = {STORE}.registry.passes.flatMap(p => p.parameters).find(p => p.name === n).lowest + (i < 3 ? 1 : {k}); }}); }})")
            self.idle()
            tab.letter("m")
            self.until(f"!{STORE}.besides.length && document.querySelectorAll('.tried tbody tr').length === {k + 1}")
        wanted = tab.state()
        names = self.ask("[...document.querySelectorAll('.tried tbody tr')].map(r => r.cells[0].textContent)")
        if len(wanted["set"]) == 4 and names[0] == names[1]:
            tab.press("z", 90, modifiers=2)
            self.idle()
            self.ask("[...document.querySelectorAll('.tried tbody tr')].at(-1).click()")
            self.until(f"!{STORE}.busy() && {STORE}.result.state.set['{numbers[3]}'] === {wanted['set'][numbers[3]]}")

    def test_the_pixel_shows_no_drawing_of_another_one(self):
        tab = self.reset()
        self.ask(f"{STORE}.setLook({{x: 20, y: 30}})")
        self.until("document.querySelector('.live-pixel[aria-busy=false] figure img')?.naturalWidth > 50 && !document.querySelector('.live-pixel .steps').hidden")
        self.ask("window.post = glintLive.api.post, glintLive.api.post = async (path, ...rest) => { if (path.endsWith('/probe')) throw glintLive.api.failure('no such luck', 'device', 500); return post(path, ...rest); }, 1")
        self.ask(f"{STORE}.setLook({{x: 60, y: 40}})")
        self.until("!document.querySelector('.live-pixel .note').hidden")
        assert self.ask("[...document.querySelectorAll('.live-pixel figure, .live-pixel .steps, .live-pixel .outcome')].every(e => !e.checkVisibility())")
        self.ask("glintLive.api.post = post, 1")
        # drawings that were replaced before they were seen are given back, too
        for k in range(12):
            self.ask(f"{STORE}.setLook({{x: {30 + k}, y: 40}})")
            time.sleep(0.05)
        self.until("document.querySelector('.live-pixel[aria-busy=false] figure img')?.naturalWidth > 50")
        assert self.ask("urls.made - urls.gone") <= 1, self.ask("urls")
        self.ask(f"{STORE}.setLook({{x: 70, y: 40}}), {STORE}.setLook({{x: null, y: null}})")
        assert self.ask("document.querySelector('.live-pixel').getAttribute('aria-busy')") == "false"
        tab.quiet()

    def test_a_field_follows_after_typing_was_taken_back(self):
        tab, number = self.reset(), self.integer()
        field = row(number["name"]) + ".querySelector('.exact')"
        self.ask(f"{field}.closest('.slot').querySelector('.fold').click(), {field}.focus()")
        tab.press("End", 35)
        tab.press("1", 49, text="1")
        tab.press("Backspace", 8)
        tab.press("Tab", 9)
        self.change(number["name"], int(number["lowest"]) + 3)
        self.idle()
        assert self.ask(f"{field}.value") == str(int(number["lowest"]) + 3)

    def test_a_slider_stands_at_the_value_of_the_picture_after_a_refusal(self):
        tab, number = self.reset(), self.integer()
        tab.write(row(number["name"]) + ".querySelector('.exact')", "99999999")
        self.until(f"{STORE}.refusal")
        tab.browser.settle()
        slider, value = row(number["name"]) + ".querySelector('input[type=range]')", self.ask(f"{STORE}.slots.flatMap(s => s.parameters).find(p => p.name === '{number['name']}').value")
        assert self.ask(f"{slider}.getAttribute('aria-valuetext')").split()[0] == str(value) and self.ask(f"+{slider}.value < +{slider}.max")

    def test_a_draft_without_a_pass_that_was_timed_is_drawn(self):
        tab = self.reset()
        self.ask(f"{STORE}.result = {{...{STORE}.result, draft: true, passes: []}}, {STORE}.emit('result'), 1")
        tab.browser.settle()
        tab.quiet()

    def test_the_focus_stays_when_slots_come_and_go(self):
        self.reset()
        add = "document.querySelector('.missing .add button')"
        self.ask("window.orders = [], new MutationObserver(() => orders.push([...document.querySelectorAll('.slots > li')].map(e => e.dataset.slot).join())).observe(document.querySelector('.slots'), {childList: true}), 1")
        self.ask("holds = path => path.endsWith('/run'), 1")  # an answer before the next frame would put it in its place at once
        self.ask(f"document.querySelector('.missing').open = true, {add}.focus(), window.adds = {add}.getAttribute('aria-label'), {add}.click(), 1")
        focused = "adds.includes(document.activeElement.closest('.slot')?.dataset.slot)"
        self.until(focused)
        self.ask("release(), 1")
        # the server says where the new one stands in the order, and it moves there
        self.idle()
        self.tab.browser.settle()
        assert self.ask("new Set(orders).size") > 1 and self.ask(focused), self.ask("[orders, document.activeElement.outerHTML.slice(0, 80)]")

    def test_the_command_that_is_copied_is_of_the_controls(self):
        tab, number = self.reset(), self.integer()
        self.ask("holds = path => path.endsWith('/run'), 1")
        self.change(number["name"], int(number["lowest"]) + 4)
        tab.letter("c")
        self.until(f"document.querySelector('.command').textContent.includes('{number['name']}={int(number['lowest']) + 4}')")
        self.ask("release()")
        self.idle()

    def test_a_server_that_was_started_again_is_asked_anew(self):
        number, token = self.integer(), self.path("token")
        with open(token, "w", encoding="utf-8") as file:
            file.write("c" * 64)
        os.chmod(token, 0o600)
        shown = self.tab.server
        server = Server(self.path("street.exr"), "--token-file", token)
        port = server.url.rstrip("/").rsplit(":", 1)[1]
        try:
            server.token = "c" * 64
            self.tab.server = server
            self.tab.open()
            self.ask(HOLD)
            self.ask(f"window.same = 1, {STORE}.pinState({{...{STORE}.state, set: {{'{number['name']}': {int(number['lowest']) + 7}}}}}, 'b'), 1")
            self.until(f"{STORE}.pinned && {LAYERS} === 2")
            self.ask("window.paths = [], holds = path => { paths.push(path); return false; }, 1")
            server.end()
            server = Server(self.path("street.exr"), "--token-file", token, "--port", port)
            # the same captures: runs and pictures are asked for again, also those of the same ids
            self.until("paths.filter(p => p.endsWith('/run')).length > 1 && paths.filter(p => p.includes('/picture')).length > 1")
            self.idle()
            assert self.ask("window.same") == 1 and self.ask(LAYERS) == 2
            server.end()
            server = Server(self.path("room.exr"), "--token-file", token, "--port", port)
            self.until("!window.same")
            self.idle()
            assert self.ask(f"{STORE}.registry.captures[0].name") != "street"
        finally:
            self.tab.server = shown
            server.end()


sys.exit(live_tab.run(Tests))
