/* The page of glint live: what glint probe says of the pixel that was chosen in the picture, for the state that is shown. */
glintLive.pixel = (function () {
    'use strict';
    const {element} = glintParts, {api, fetch} = glintLive;
    const RETRY_MS = 300;

    function make(store) {
        const self = {store, asked: null, stop: null, url: null, done: null};
        self.title = element('h3', {id: 'pixel-title'});
        self.hint = element('p', {class: 'faint'}, 'Click a pixel of the picture, or press Enter on the one that is pointed at, to see its rays.');
        self.close = element('button', {type: 'button', 'aria-label': 'close the pixel', click: () => store.setLook({x: null, y: null})}, 'Close');
        self.large = element('img', {alt: ''});
        const shut = element('button', {type: 'button', click: () => self.dialog.close()}, 'Close');
        self.dialog = element('dialog', {class: 'drawing', 'aria-label': 'rays of the pixel, enlarged'}, element('div', {class: 'bar'}, element('h3'), shut), self.large);
        const enlarge = () => { self.dialog.querySelector('h3').textContent = self.title.textContent; self.dialog.showModal(); };
        self.enlarge = element('button', {type: 'button', hidden: '', title: 'the drawing as large as the window', click: enlarge}, 'Enlarge');
        self.image = element('img', {alt: '', title: 'a click enlarges the drawing', click: enlarge});
        self.wait = element('p', {class: 'faint', role: 'status'});
        self.outcome = element('div', {class: 'scroll'});
        self.explain = element('pre', {class: 'explain', tabindex: 0, 'aria-label': 'command line that explains the pixel'});
        self.sentences = element('div', null, element('p', {class: 'faint'}, 'Why, in sentences, and which change would help, once the run is written by the command line of the state:'), self.explain);
        self.why = element('p', {class: 'faint'});
        self.failure = element('p', {class: 'note', role: 'alert', hidden: ''});
        self.text = element('pre', {tabindex: 0, 'aria-label': 'what glint probe says'});
        self.steps = element('details', {class: 'steps'}, element('summary', null, 'Every step in words'), self.text);
        self.drawing = element('figure', {tabindex: 0, role: 'group', 'aria-label': 'rays of the pixel: arrow keys go to the next pixel, Shift by ten, Escape closes',
            keydown: event => { if (key(store, event)) event.preventDefault(); }}, self.image, self.why);
        self.inner = element('div', null, element('div', {class: 'bar'}, self.title, element('span', {class: 'together'}, self.enlarge, self.close)), self.wait, self.failure, self.outcome,
            self.drawing, self.steps, self.sentences, self.dialog);
        self.e = element('section', {class: 'live-pixel', 'aria-labelledby': 'pixel-title'}, self.hint, self.inner);
        for (const e of [self.drawing, self.steps]) e.hidden = true;
        for (const what of ['look', 'result']) store.on(what, () => refresh(self));
        refresh(self);
        return self.e;
    }

    function key(store, event) {
        const {look: {x, y}} = store, way = {ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1]}[event.key];
        const size = store.registry.captures[store.state.capture]?.size, by = event.shiftKey ? 10 : 1;
        if (event.key === 'Escape') store.setLook({x: null, y: null});
        else if (way && size && !event.ctrlKey && !event.altKey && !event.metaKey)
            store.setLook({x: Math.min(size[0] - 1, Math.max(0, x + by * way[0])), y: Math.min(size[1] - 1, Math.max(0, y + by * way[1]))});
        else return false;
        return true;
    }

    const chosen = ({look: {x, y}}) => typeof x === 'number' && typeof y === 'number' ? [x, y] : null;

    /* Asks again once a whole frame of another state is there, or another pixel is chosen. */
    function refresh(self) {
        const {store} = self, {result} = store, at = chosen(store);
        self.inner.hidden = !at;
        self.hint.hidden = !!at;
        if (!at) {
            self.stop?.abort();
            self.asked = null;
            self.e.setAttribute('aria-busy', 'false');
            store.setBesides('pixel', false);
            return;
        }
        self.title.textContent = `Pixel ${at[0]},${at[1]}`;
        self.explain.textContent = `glint explain run ${at[0]},${at[1]}`;
        if (!result) return;
        const wanted = JSON.stringify([at, result.draft ? self.run : result.run]);
        if (!result.draft) { self.run = result.run; self.state = result.state; }
        if (wanted === self.asked || !self.state) return;
        self.asked = wanted;
        ask(self, at, wanted);
    }

    /* The pipeline's own ray comes first, and the rays of the reference, which take longer, follow. */
    async function ask(self, at, wanted) {
        self.stop?.abort();
        const stop = self.stop = new AbortController();
        self.e.setAttribute('aria-busy', 'true');
        for (const e of [self.drawing, self.outcome, self.steps]) e.classList.add('stale');
        self.store.setBesides('pixel', true);
        self.wait.textContent = 'Tracing the rays of this pixel \u2026';
        for (const reference of [false, true]) {
            const answer = await probe(self, at, wanted, reference, stop.signal);
            if (self.asked !== wanted) return;
            if (answer) show(self, answer, reference);
            self.wait.textContent = answer && !reference ? 'Tracing the rays of the reference to compare with \u2026' : '';
            if (!answer) break;
        }
        self.e.setAttribute('aria-busy', 'false');
        self.store.setBesides('pixel', false);
    }

    /* The answer, or null. A run may take the replay away: then it is asked again. */
    async function probe(self, [x, y], wanted, reference, signal) {
        while (self.asked === wanted) {
            try {
                return await api.post('/api/v1/probe', {state: self.state, x, y, reference, client: self.store.client}, signal);
            } catch (error) {
                if (signal.aborted || self.asked !== wanted) return null;
                if (!fetch.givenUp(error)) { fail(self, error); return null; }
            }
            await new Promise(done => setTimeout(done, RETRY_MS));
        }
        return null;
    }

    /* The comparison with the reference that the text ends with, as cells; null if there is none. */
    function comparisonOf(text) {
        const lines = text.trimEnd().split('\n\n').at(-1).split('\n').map(line => line.trimEnd().split(/ {2,}/));
        return lines.length > 1 && lines[0][0] === '' && lines.every(cells => cells.length === 3) ? lines : null;
    }

    function drawOutcome(self, text) {
        const [heads, ...rows] = comparisonOf(glintChart.text(text)) || [[]];
        self.outcome.hidden = !rows.length;
        const cells = (tag, texts) => texts.map((t, i) => element(i ? tag : 'th', null, t));
        self.outcome.replaceChildren(element('table', {class: 'outcome'}, element('thead', null, element('tr', null, ...cells('th', heads))),
            element('tbody', null, ...rows.map(row => element('tr', null, ...cells('td', row))))));
    }

    /* The drawing is a picture and never part of the page: it holds texts of strangers. */
    function show(self, {svg, no_drawing: why, text}, reference) {
        self.failure.hidden = true;
        self.drawing.hidden = self.steps.hidden = false;
        for (const e of [self.drawing, self.outcome, self.steps]) e.classList.remove('stale');
        drawOutcome(self, reference ? text : '');
        const before = self.url;
        self.url = svg ? URL.createObjectURL(new Blob([svg], {type: 'image/svg+xml'})) : null;
        self.image.hidden = !svg;
        self.enlarge.hidden = !svg;
        for (const image of [self.image, self.large]) if (svg) image.src = self.url; else image.removeAttribute('src');
        if (before) URL.revokeObjectURL(before);
        self.image.alt = self.large.alt = svg ? `the rays of ${self.title.textContent}; the text below says the same` : '';
        self.why.hidden = !!svg;
        self.why.textContent = glintChart.text(why || '');
        self.text.textContent = glintChart.text(text);
    }

    /* What was drawn of another pixel or state does not stay below the title of this one. */
    function fail(self, error) {
        if (self.drawing.classList.contains('stale')) self.drawing.hidden = self.steps.hidden = self.outcome.hidden = self.enlarge.hidden = true;
        self.failure.hidden = false;
        self.failure.textContent = glintChart.text(error.message);
    }

    return make;
})();
