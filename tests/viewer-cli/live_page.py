"""The page of glint live in headless Chromium, over the real server: live_page.py GLINT FOLDER_OF_SCRIPTS DOC. Each control once, a drag with
pictures in between, refusals, undo, links, two tabs. Speaks TAP."""
import json
import os
import re
import sys
import time

import live_tab
from browser import Browser
from live_tab import SIZE, STORE, Server, Tab, button, row, slot
from tap import glint


class Tests(live_tab.Tests):
    # ---- The frame of it ----

    def test_no_name_of_the_registry_stands_in_the_code(self):
        with open(sys.argv[3], encoding="utf-8") as file:
            own = set(re.findall(r"\w+", " ".join(re.findall(r'["`]([^"`]*)["`]', file.read()))))  # words of the interface
        names = {e["effect"] for e in self.registry["effects"]} | {p["name"] for p in self.registry["presets"]}
        for v in self.registry["passes"]:
            names |= {v["slot"], *(p["name"] for p in v["parameters"]), *(i["name"] for i in v["writes"])}
        scripts = [f for f in os.listdir(sys.argv[2]) if f.startswith("live") and f.endswith(".js")]
        assert len(names) > 500 and len(scripts) > 10
        for script in scripts:
            with open(os.path.join(sys.argv[2], script), encoding="utf-8") as file:
                strings = re.findall(r"'((?:[^'\\\n]|\\.)*)'|`([^`]*)`", file.read())
            found = {s for pair in strings for s in pair if s in names - own - {"light", "blur"}}  # light and dark; an event of browsers
            found |= {n for n in names if "_" in n or "." in n for pair in strings for s in pair if re.search(rf"\b{re.escape(n)}\b", s)} - own
            assert not found, (script, found)

    def test_the_token_leaves_the_address_and_is_asked_for(self):
        tab = self.reset()
        assert self.server.token not in self.ask("location.href")
        self.ask("sessionStorage.clear()")
        tab.go("")
        assert self.ask("document.documentElement.dataset.ready") == "token" and "glint live prints" in self.ask("document.body.textContent")
        tab.write("document.getElementById('token')", "0123456789abcdef" * 4)
        self.until("document.body.textContent.includes('does not know this token')")
        tab.write("document.getElementById('token')", f"{self.server.url}#{self.server.token}")
        self.until("document.documentElement.dataset.ready === 'yes'")
        self.idle()
        tab.go("")  # kept for the session
        self.until("document.documentElement.dataset.ready === 'yes'")
        tab.quiet()

    def test_the_panel_has_what_the_registry_and_the_state_have(self):
        tab = self.reset()
        slots = json.loads(self.ask(f"JSON.stringify({STORE}.result.slots)"))
        shown = self.ask("[...document.querySelectorAll('.slot')].map(s => [s.dataset.slot, s.querySelector('.head select').value, [...s.querySelectorAll('.parameter')].map(p => p.dataset.name)])")
        parameters = {(v["slot"], v["variant"]): [p["name"] for p in v["parameters"]] for v in self.registry["passes"]}
        assert shown == [[s["slot"], s["variant"], parameters[s["slot"], s["variant"]]] for s in slots] and len(shown) > 10, shown
        options = self.ask("[...document.querySelectorAll('.slot')].map(s => [...s.querySelectorAll('.head select option')].map(o => o.value))")
        for (name, _, _), variants in zip(shown, options):
            wanted = [v["variant"] for v in self.registry["passes"] if v["slot"] == name]
            assert variants == wanted + ["none"] * ("none" not in wanted), (name, variants)
        passes = {p["slot"]: p for p in json.loads(self.ask(f"JSON.stringify({STORE}.result.passes)"))}
        why = dict(self.ask("[...document.querySelectorAll('.slot')].map(s => [s.dataset.slot, s.querySelector('.why').textContent])"))
        left_out = [n for n, p in passes.items() if not p["ran"] and not p["cached"]]
        assert left_out and all(passes[n]["reason"] in why[n] for n in left_out), why
        times = dict(self.ask("[...document.querySelectorAll('.slot')].map(s => [s.dataset.slot, parseFloat(s.querySelector('.time').textContent)])"))
        assert all(abs(times[n] - p["ns"] / 1e6) <= 0.01 * p["ns"] / 1e6 for n, p in passes.items() if p["ns"]), (times, passes)
        tab.quiet()

    # ---- Each control once ----

    def test_every_parameter_has_a_control_that_changes_it(self):
        tab = self.reset()
        changed = set()
        for name in self.ask("[...document.querySelectorAll('.slot')].map(s => s.dataset.slot)"):
            names = self.ask(f"""[...{slot(name)}.querySelectorAll('.parameter')].map(row => {{
                const range = row.querySelector('input[type=range]'), box = row.querySelector('input[type=checkbox]'), select = row.querySelector('select');
                if (box) box.click();
                else if (select) {{ select.selectedIndex = (select.selectedIndex + 1) % select.options.length; select.dispatchEvent(new Event('change')); }}
                else {{ range.value = +range.value + (range.value === range.max ? -1 : 1); range.dispatchEvent(new Event('input')); }}
                return row.dataset.name;
            }})""")
            if not names:
                continue
            assert set(tab.state()["set"]) == set(names), (name, names, tab.state()["set"])
            self.idle()
            marked = self.ask(f"[...{slot(name)}.querySelectorAll('.parameter.differs')].map(r => r.dataset.name)")
            kept = set(tab.shown()["set"])
            if not self.ask(f"{STORE}.refusal || {STORE}.error"):
                assert kept == set(names) == set(marked), (name, kept ^ set(names), marked)
                changed |= kept
            self.ask(f"{slot(name)}.querySelector('.head .revert')?.click()")
            self.idle()
            assert not tab.state()["set"] and not self.ask("document.querySelectorAll('.parameter.differs').length"), name
        assert len(changed) > 0.9 * len(self.parameters()), (len(changed), len(self.parameters()))
        tab.quiet()

    def test_slots_are_switched_replaced_added_forced_and_taken_back(self):
        tab = self.reset()
        passes = json.loads(self.ask(f"JSON.stringify({STORE}.result.passes)"))
        several = next(p["slot"] for p in passes if p["ran"] and len([v for v in self.registry["passes"] if v["slot"] == p["slot"]]) > 2)
        head = slot(several) + ".querySelector('.head')"
        tab.click(head + ".querySelector('input[type=checkbox]')")
        self.until(f"{STORE}.result.state.skip.length")
        assert tab.state()["skip"] == [several] and "skipped" in self.ask(head + ".querySelector('.why').textContent")
        tab.click(head + ".querySelector('.revert')")
        self.until(f"!{STORE}.result.state.skip.length")
        other = next(v["variant"] for v in self.registry["passes"] if v["slot"] == several and v["variant"] != self.ask(head + ".querySelector('select').value"))
        self.ask(f"(s => {{ s.value = '{other}'; s.dispatchEvent(new Event('change')); }})({head}.querySelector('select'))")
        self.until(f"{STORE}.result.state.use['{several}'] === '{other}'")
        expected = [p["name"] for v in self.registry["passes"] if (v["slot"], v["variant"]) == (several, other) for p in v["parameters"]]
        assert self.ask(f"[...{slot(several)}.querySelectorAll('.parameter')].map(r => r.dataset.name)") == expected
        left_out = next(p["slot"] for p in passes if not p["ran"] and not p["cached"])
        tab.click(slot(left_out) + ".querySelector('.force')")
        self.until(f"{STORE}.result.state.force.length")
        order = self.ask("[...document.querySelectorAll('.slot')].map(s => s.dataset.slot)")
        last = passes[-1]["slot"]
        self.ask(f"(s => {{ s.value = 'none'; s.dispatchEvent(new Event('change')); }})({slot(last)}.querySelector('.head select'))")
        self.until(f"{STORE}.result.state.use['{last}'] === 'none'")
        self.idle()
        assert self.ask("[...document.querySelectorAll('.slot')].map(s => s.dataset.slot)") == order, "a slot that is left out keeps its place"
        tab.click("document.querySelector('.missing summary')")
        add = self.ask("document.querySelector('.missing button').getAttribute('aria-label')")
        added = re.fullmatch(r"add (\w+): (\w+)", add).groups()
        tab.click("document.querySelector('.missing button')")
        self.until(f"{STORE}.state.use['{added[0]}'] === '{added[1]}'")
        self.idle()
        tab.click("[...document.querySelectorAll('.pipeline button')].find(b => b.textContent.startsWith('Reset all'))")
        self.idle()
        state = tab.state()
        assert not state["use"] and not state["set"] and not state["skip"] and not state["force"], state
        tab.quiet()

    def test_search_finds_slots_parameters_and_help(self):
        tab = self.reset()
        listed = "[...document.querySelectorAll('.parameter')].filter(r => r.offsetParent).map(r => r.dataset.name)"
        name, parameter = next((n, p) for n, p in self.parameters().items() if len(p["help"].split()) > 5)
        for words in (name.split(".")[1], parameter["help"][:30].lower()):
            self.ask(f"(s => {{ s.value = {json.dumps(words)}; s.dispatchEvent(new Event('input')); }})(document.getElementById('search'))")
            found = self.ask(listed)
            assert name in found and len(found) < len(self.parameters()), (words, found)
            assert all(all(w in f"{p['name']} {p['help']} {p['source']} {' '.join(p.get('choices', []))}".lower() for w in words.split())
                       or words in f.lower() for f in found for p in [self.parameters().get(f)] if p), found
        self.ask("(s => { s.value = 'no such word'; s.dispatchEvent(new Event('input')); })(document.getElementById('search'))")
        assert not self.ask(listed) and "Nothing fits" in self.ask("document.querySelector('.pipeline').innerText")
        self.ask("(s => { s.value = ''; s.dispatchEvent(new Event('input')); })(document.getElementById('search'))")
        number = self.integer()
        tab.write(row(number["name"]) + ".querySelector('.exact')", str(int(number["lowest"]) + 3))
        self.idle()
        tab.click("document.querySelector('.pipeline .tools input[type=checkbox]')")
        assert self.ask(listed) == [number["name"]], self.ask(listed)
        tab.click(row(number["name"]) + ".querySelector('.revert')")
        self.idle()
        assert not tab.state()["set"]

    def test_preset_b_and_swap(self):
        tab = self.reset()
        first, second = tab.state()["preset"], next(p["name"] for p in self.registry["presets"] if p["name"] != tab.state()["preset"])
        choose = lambda text: self.ask(f"""(s => {{ s.value = [...s.options].find(o => o.textContent === '{text}').value; s.dispatchEvent(new Event('change')); }})(document.getElementById('pin'))""")
        choose("this state")
        self.until(f"{STORE}.pinned")
        self.ask(f"(s => {{ s.value = '{second}'; s.dispatchEvent(new Event('change')); }})(document.getElementById('preset'))")
        self.until(f"{STORE}.result.state.preset === '{second}'")
        self.idle()
        tab.click("document.getElementById('swap')")
        self.until(f"{STORE}.result.state.preset === '{first}'")
        assert self.ask(f"{STORE}.pinned.result.state.preset") == second
        choose(second)
        self.until(f"{STORE}.pinned.title === '{second}'")
        choose("truth of the capture")
        self.until(f"{STORE}.pinned.of === 'truth'")
        assert self.ask("document.getElementById('swap').disabled")
        choose("nothing")
        self.until(f"!{STORE}.pinned")
        tab.quiet()

    def test_figures_have_differences_and_points_go_back(self):
        tab = self.reset()
        self.ask("(b => b.checked || b.click())(document.querySelector('.figures-panel input[type=checkbox]'))")
        self.until("document.querySelector('.tried svg')")
        text = lambda: self.ask("document.querySelector('.figures-panel').innerText")
        number = self.integer()
        tab.letter("p")
        self.until(f"{STORE}.pinned")
        # without figures of B there are no differences to them
        self.ask("(b => b.click())(document.querySelector('.figures-panel input[type=checkbox]'))")
        self.ask(f"{STORE}.pinState({{...{STORE}.state, preset: {STORE}.registry.presets[1].name, use: {{}}}})")
        self.until(f"{STORE}.pinned.result.state.preset !== {STORE}.state.preset && document.querySelector('.figures-panel .scroll:last-child td.change')")
        ends = "[...document.querySelectorAll('.figures-panel .scroll:last-child td.change')].map(e => e.textContent).join('')"
        assert not self.ask(ends), self.ask(ends)
        tab.letter("p")
        self.ask("(b => b.click())(document.querySelector('.figures-panel input[type=checkbox]'))")
        tab.write(row(number["name"]) + ".querySelector('.exact')", str(int(number["lowest"])))
        self.idle()
        self.until("document.querySelectorAll('.figures-panel td.change').length && /[+\u2212]\\d/.test(document.querySelector('.figures-panel td.change').textContent)")
        answer = self.ask(f"""glintLive.api.post('/api/v1/figures', {{state: {STORE}.state, effect: {STORE}.effect, against: 'truth', metrics: ['{self.registry["metric"]}'], rounds: 0}})""")
        total = next(e["value"] for e in answer["errors"] if e["metric"] == self.registry["metric"])
        self.until(f"Math.abs(parseFloat(document.querySelector('.figures-panel table.figures tbody td').textContent) - {total}) <= 1e-3 * {total}")
        assert answer["ends"] and all(e["text"] in text() for e in answer["ends"])
        self.until("document.querySelectorAll('.tried tbody tr').length === 2 || (document.querySelector('.tried details').open = true, false)")
        self.ask("[...document.querySelectorAll('.tried tbody tr')].find(r => !r.textContent.includes('=')).click()")
        self.until(f"!Object.keys({STORE}.state.set).length")
        self.idle()
        assert not tab.shown()["set"]
        self.ask("(f => { f.value = 1; f.dispatchEvent(new Event('change')); })(document.querySelector('.figures-panel input[type=number]'))")
        tab.click("document.getElementById('measure')")
        self.until("document.querySelector('.figures-panel').innerText.includes('when a cube map changes')", 40)
        tab.quiet()

    def test_out(self):
        tab = self.reset()
        self.until("document.querySelector('.tried svg')")  # what is above is as high as it will be
        number = self.integer()
        tab.write(row(number["name"]) + ".querySelector('.exact')", str(int(number["lowest"]) + 1))
        self.idle()
        command = self.ask("document.querySelector('.command').textContent")
        assert f"{number['name']}={int(number['lowest']) + 1}" in command, command
        self.ask("window.saved = {}; window.made = URL.createObjectURL; URL.createObjectURL = b => { b.text().then(t => saved.text = t); return made.call(URL, b); }; 1")
        tab.click("document.getElementById('save-preset')")
        preset = json.loads(self.until("saved.text"))
        with open(self.path("mine.json"), "w", encoding="utf-8") as file:
            json.dump(preset, file)
        glint("plan", self.path("street.exr"), "--preset", self.path("mine.json"))
        tab.click("document.getElementById('write-run')")
        self.until("document.querySelector('.out').innerText.includes('Written')")
        with open(self.path("runs/mine/run.json"), encoding="utf-8") as file:
            run = json.load(file)
        set_, value = number["name"].split(".")[0], number["name"].split(".")[1]
        assert next(p for p in run["passes"] if p["slot"] == set_)["parameters"][value] == number["lowest"] + 1
        tab.click("document.getElementById('copy-link')")
        assert "#s=" in self.ask("document.querySelector('.link').textContent")
        tab.click("document.getElementById('copy-command')")
        self.until("/Copied|Selected/.test(document.querySelector('.out [role=status]').textContent)")
        tab.quiet()

    def test_the_shot_is_stepped_and_played(self):
        tab = self.reset()
        tab.letter("]")
        self.until(f"{STORE}.result.state.capture === 1")
        self.idle()
        assert "room" in self.ask("document.querySelector('.frame-name').textContent") and not self.ask(f"{STORE}.canUndo()")
        tab.letter("[")
        self.until(f"{STORE}.result.state.capture === 0")
        self.ask("results.length = 0")
        tab.click(button("Play"))
        self.until("results.length >= 4", 40)
        tab.click(button("Pause"))
        self.idle()
        frames = [r["state"]["capture"] for r in self.ask("results")]
        assert frames[:4] in ([0, 1, 0, 1], [1, 0, 1, 0]) and not self.ask(f"{STORE}.result.draft"), frames
        tab.quiet()

    # ---- Changes ----

    def drag(self, parameter, steps=24):
        slider = row(parameter["name"]) + ".querySelector('input[type=range]')"
        fold = slot(parameter["name"].split(".")[0]) + ".querySelector('.fold')"
        if self.ask(f"{fold}.getAttribute('aria-expanded')") != "true":
            self.tab.click(fold)
        x, y, w, h = self.tab.box(slider)
        at = lambda k: {"x": x + 8 + (w - 16) * k / steps, "y": y + h / 2}
        mouse = lambda kind, k, buttons=1: self.tab.browser.call("Input.dispatchMouseEvent", type=kind, button="left", buttons=buttons, clickCount=1, **at(k))
        mouse("mousePressed", 0)
        for k in range(1, steps + 1):
            mouse("mouseMoved", k)
            time.sleep(0.04)
            if k % 8 == 0 and k < steps:  # a busy machine: the drag goes on when a picture has come
                seen = len(self.ask("results"))
                end = time.monotonic() + 30
                while len(self.ask("results")) == seen and time.monotonic() < end:
                    time.sleep(0.04)
        before_release = len(self.ask("results"))
        mouse("mouseReleased", steps, 0)
        return before_release

    def test_a_drag_shows_pictures_in_between_and_is_one_step(self):
        tab, number = self.reset(), self.integer()
        self.ask("""window.pictures = new Set(); const copy = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true}); (function look() {
            const c = document.querySelector('.live-picture canvas');
            if (c?.width) {
                [copy.canvas.width, copy.canvas.height] = [c.width, c.height];
                copy.drawImage(c, 0, 0);
                let sum = 7;
                for (const v of copy.getImageData(0, 0, c.width, c.height).data) sum = (31 * sum + v) | 0;
                pictures.add(sum);
            }
            setTimeout(look, 25);
        })()""")
        self.until("pictures.size === 1")
        for k in range(2):  # the first draft makes the smaller captures
            tab.write(row(number["name"]) + ".querySelector('.exact')", str(int(number["lowest"]) + k))
            self.idle()
        self.ask("results.length = 0")
        before, steps = tab.state(), self.ask(f"{STORE}.canUndo()")
        during = self.drag(number)
        self.idle()
        results = self.ask("results")
        values = [r["state"]["set"].get(number["name"], number["default"]) for r in results]
        assert during >= 2 and len(set(values)) >= 3 and values == sorted(values) and values[-1] == number["highest"], (during, values)
        assert self.until("pictures.size >= 3"), self.ask("pictures.size")
        assert not results[-1]["draft"]
        tab.press("z", 90, modifiers=2)
        self.idle()
        assert tab.shown() == before and steps, tab.shown()
        tab.press("Z", 90, modifiers=2 | 8)
        self.idle()
        assert tab.shown()["set"] == {number["name"]: number["highest"]}
        tab.quiet()

    def test_where_replays_are_slow_a_draft_comes_first(self):
        tab, number = self.reset(), self.integer()
        self.ask("""window.asked = []; window.post = glintLive.api.post; glintLive.api.post = async (path, body, signal) => {
            if (path.endsWith('/run')) asked.push(body.draft);
            const answer = await post(path, body, signal);
            return path.endsWith('/run') ? {...answer, seconds: 3} : answer;
        }; 1""")
        field = row(number["name"]) + ".querySelector('.exact')"
        tab.write(field, str(int(number["lowest"])))
        self.idle()  # the first slow one
        self.ask("results.length = 0, asked.length = 0")
        tab.write(field, str(int(number["lowest"]) + 2))
        self.until(f"document.querySelector('.live-over .draft') && results.some(r => r.draft)")
        self.idle()
        results = self.ask("results")
        assert [r["draft"] for r in results] == [True, False] and results[0]["run"] != results[1]["run"], results
        assert all(r["state"]["set"] == {number["name"]: number["lowest"] + 2} for r in results)
        self.ask("asked.length = 0, results.length = 0")
        self.drag(number, 12)
        self.idle()
        assert self.ask("results").pop()["draft"] is False and self.ask("asked.filter(d => d).length") >= 3, (self.ask("asked"), self.ask("results"))
        tab.quiet()

    def test_where_replays_are_fast_nothing_is_compiled_first(self):
        tab, number = self.reset(), self.integer()
        unseen = int(0.4137 * number["highest"] + 0.5863 * number["lowest"])  # for which no other test has had a program compiled
        self.ask(f"{STORE}.registry.device.cpu = false; window.quick = []; {STORE}.on('result', s => quick.push([s.result.quick, s.result.run])); 1")
        try:
            tab.write(row(number["name"]) + ".querySelector('.exact')", str(unseen))
            self.until("quick.length > 1")
            self.idle()
            first, second = self.ask("quick")
            assert first[0] and not second[0] and first[1] != second[1], (first, second)
            assert tab.state()["set"] == {number["name"]: unseen}
            tab.quiet()
        finally:
            self.ask(f"{STORE}.registry.device.cpu = true")

    def test_a_bad_value_is_refused_with_the_range(self):
        tab, number = self.reset(), self.integer()
        field, before = row(number["name"]) + ".querySelector('.exact')", tab.state()
        tab.click(slot(number["name"].split(".")[0]) + ".querySelector('.fold')")
        for bad in (str(int(number["highest"]) + 1), "many"):
            tab.write(field, bad)
            self.until(f"{STORE}.refusal")
            self.tab.browser.settle()
            said = self.ask(row(number["name"]) + ".querySelector('.refusal').textContent")
            assert number["name"] in said and bad in said and (bad == "many" or f"{number['highest']:g}" in said), said
            assert self.ask(f"{field}.getAttribute('aria-invalid')") == "true" and self.ask(f"{field}.value") == bad
            assert tab.state() == before and self.ask("document.querySelector('.live-picture canvas').width") == SIZE[0]
        tab.write(field, str(int(number["lowest"]) + 1))
        self.until(f"{STORE}.result.state.set['{number['name']}'] === {int(number['lowest']) + 1}")
        self.idle()
        assert self.ask(f"{field}.getAttribute('aria-invalid')") == "false" and not self.ask(f"{row(number['name'])}.querySelector('.refusal').offsetParent")
        tab.press("z", 90, modifiers=2)
        self.idle()
        assert tab.state() == before and not self.ask(f"{STORE}.canUndo()")
        tab.quiet()

    def test_a_run_that_fails_is_said_and_the_picture_stays(self):
        tab, number = self.reset(), self.integer()
        self.until("document.querySelector('.tried svg')")
        before = tab.state()
        self.ask("""window.post = glintLive.api.post; glintLive.api.post = (path, ...rest) => path.endsWith('/run')
            ? Promise.reject(glintLive.api.failure('the device is lost', 'device', 500)) : post(path, ...rest); 1""")
        tab.write(row(number["name"]) + ".querySelector('.exact')", str(int(number["lowest"])))
        self.until("[...document.querySelectorAll('[role=alert]')].some(e => e.offsetParent && e.textContent.includes('the device is lost'))")
        time.sleep(0.5)  # until what follows a run begins
        assert tab.shown() == before and self.ask("document.querySelector('.live-picture canvas').width") == SIZE[0]
        assert tab.state()["set"] == {number["name"]: number["lowest"]}
        self.ask("glintLive.api.post = post; 1")
        tab.press("z", 90, modifiers=2)
        self.until(f"!{STORE}.error")
        self.idle()
        assert tab.shown() == before
        tab.quiet()

    def test_a_link_brings_state_and_look_and_no_token(self):
        tab, number = self.reset(), self.integer()
        tab.write(row(number["name"]) + ".querySelector('.exact')", str(int(number["lowest"]) + 5))
        image = self.ask(f"{STORE}.result.images.find(i => i.slot).name")
        self.ask(f"{STORE}.setLook({{image: '{image}', exposure: 1.5, x: 12, y: 34}})")
        self.idle()
        link, state, look = self.ask(f"{STORE}.link()"), tab.state(), self.ask(f"{STORE}.look")
        self.until(f"location.href === {STORE}.link()")
        assert self.server.token not in link
        tab.open("#" + link.split("#")[1])
        assert tab.shown() == state and tab.state() == state and self.ask(f"{STORE}.look") == look, (tab.state(), state, self.ask(f"{STORE}.look"), look)
        # B is in the link, too, and a tab that is opened by one asks the other tabs for the token
        tab.letter("p")
        self.until(f"{STORE}.pinned && location.href === {STORE}.link()")
        pinned, link = self.ask(f"{STORE}.pinned.result.state"), self.ask("location.href")
        with tab.browser.another_page():
            tab.browser.call("Page.navigate", url=link)
            self.until(f"typeof glintLive !== 'undefined' && {STORE}?.pinned")
            assert self.ask(f"{STORE}.pinned.result.state") == pinned and tab.shown() == state and self.server.token not in self.ask("location.href")
        broken = self.ask(f"""(() => {{ const s = {STORE}; const f = s.state; s.state = {{...f, preset: 'none such'}}; const l = s.link(); s.state = f; return l; }})()""")
        tab.open("#" + broken.split("#")[1])
        assert tab.shown()["preset"] == self.registry["start"]["preset"] and "none such" in self.ask("document.querySelector('.news').textContent")

    def test_two_tabs_share_the_replay(self):
        tab, number = self.reset(), self.integer()
        with Browser() as other_browser:
            other = Tab(other_browser, self.server)
            other.open()
            for k in range(6):
                for t, v in ((tab, k), (other, 40 - k)):
                    t.ask(f"{STORE}.change(s => {{ s.set['{number['name']}'] = {int(number['lowest']) + 1 + v}; }})")
            for t, v in ((tab, 5), (other, 35)):
                t.until(f"{STORE}.result.state.set['{number['name']}'] === {int(number['lowest']) + 1 + v}")
                t.idle()
                assert not t.ask(f"{STORE}.error") and not t.ask(f"{STORE}.result.draft")
            other.quiet()
        tab.quiet()

    def test_a_server_that_ends_is_said(self):
        tab, number = self.reset(), self.integer()
        server = Server(self.path("room.exr"))
        shown = self.tab.server
        try:
            self.tab.server = server
            tab.open()
            server.end()
            self.until("[...document.querySelectorAll('.notes .error')].some(e => e.offsetParent && e.textContent.includes('does not answer'))")
            self.ask(f"{STORE}.change(s => {{ s.set['{number['name']}'] = {int(number['lowest'])}; }})")
            self.until(f"{STORE}.error")
            assert self.ask("document.querySelector('.live-picture canvas').width") == SIZE[0]
        finally:
            self.tab.server = shown


sys.exit(live_tab.run(Tests))
