/* The page of glint live: the picture of the state (A), beside that of a pinned run (B) or as a heat map of both, with the values under
   the pointer. Changes of state, image and view replace it in place. */
glintLive.picture = (function () {
    'use strict';
    const {element} = glintParts, {api, images, view, fetch} = glintLive;
    const RESIZE_MS = 150; /* after the last change of the window */
    const HEAT = 'alone0'; /* the mode of the stage in which the heat map is seen */

    const frameOf = store => store.registry.captures[store.state.capture]?.size || [16, 9];

    /* ---- Places: pixels of the frame, and of a picture that is whole fractions of it ---- */

    /* Whether a picture has the frame's view, at full size or halved some times. */
    function isOfFrame([width, height], [w, h]) {
        for (let k = 0; k < 16; k++) if (Math.ceil(width / 2 ** k) === w && Math.ceil(height / 2 ** k) === h) return true;
        return false;
    }

    const between = (v, from, to) => Math.min(to - 1, Math.floor((v + 0.5) * to / from));

    /* ---- Values ---- */

    function valueText(value, word) {
        const text = typeof value === 'number' ? glintValues.words(value) : value;
        return word ? `${text}: ${word}` : text;
    }

    /* What the stage shows of the answer of /api/v1/values; `of`: [{caption}, …] in the same order, A and then B first. */
    function valueTable(of, values, x, y) {
        const channels = [...new Set(values.flatMap(v => v.channels || []))];
        const rows = values.map((v, i) => v.error ? [`${of[i].caption}: ${v.error}`, channels.map(() => '\u2013')]
            : [of[i].caption, channels.map(c => c in at(v) ? valueText(at(v)[c], v.words?.[v.channels.indexOf(c)]) : '\u2013')]);
        function at(v) { return Object.fromEntries((v.channels || []).map((c, k) => [c, v.values[k]])); }
        const [a, b] = values, known = b && !a.error && !b.error && of[1].b;
        if (known) rows.splice(2, 0, ['B \u2212 A', channels.map(c => difference(at(a)[c], at(b)[c], a.words?.[a.channels.indexOf(c)]))]);
        const texel = a.error || (a.x === x && a.y === y) ? '' : ` (texel ${a.x},${a.y})`;
        return {title: `${x},${y}${texel}`, channels, unit: a.unit && a.unit !== '1' ? a.unit : '', rows};
    }

    function difference(a, b, word) {
        if (a === undefined || b === undefined) return '\u2013';
        if (a === b) return '0';
        if (word) return 'another';
        return typeof a === 'number' && typeof b === 'number' ? glintValues.words(b - a)
            : typeof a === 'number' || typeof b === 'number' ? 'only one is finite' : 'not comparable';
    }

    /* ---- What lies over the picture and below it ---- */

    function progressBar() {
        const fill = element('i'), text = element('span');
        const e = element('div', {class: 'progress', role: 'progressbar', 'aria-label': 'replay', 'aria-valuemin': 0, 'aria-valuemax': 100}, fill, text);
        return {e, draw(progress) {
            const share = progress ? Math.round(100 * Math.min(1, Math.max(0, progress.done || 0))) : 0;
            e.hidden = !progress;
            e.setAttribute('aria-valuenow', share);
            fill.style.width = `${share}%`;
            text.textContent = progress ? glintChart.text(progress.what) : '';
        }};
    }

    function overlay() {
        const progress = progressBar(), draft = element('span', {class: 'draft', role: 'status'}), failure = element('p', {class: 'note', role: 'alert'});
        return {e: element('div', {class: 'live-over'}, progress.e, draft, failure), draw(store, wrong, waits, draws) {
            const message = store.error ? store.error.message || store.error : wrong.A || wrong.B || wrong.D;
            progress.draw(store.running || !store.besides.length ? store.progress : null); /* what is done beside it changes no picture */
            draft.textContent = waits ? 'Drawing the picture \u2026' : draws ? `Draft: half the resolution${store.error ? '' : ', the whole frame follows'}` : '';
            draft.hidden = !draft.textContent;
            failure.hidden = !message;
            failure.textContent = !message ? '' : glintChart.text(message) +
                (store.error && store.result ? '\nThe picture is that of the last run that succeeded.' : '');
        }};
    }

    function warningOf(shown) {
        return ['A', 'B'].map(k => [k, shown[k]?.head.invalid]).filter(([, count]) => count > 0).map(([k, count]) =>
            `${glintParts.numberText(count, 0)} ${count === 1 ? 'pixel' : 'pixels'} of ${k} ${count === 1 ? 'is' : 'are'} not finite (NaN or infinite).`).join(' ');
    }

    /* ---- The element ---- */

    function make(store) {
        const self = {store, shown: {A: null, B: null, D: null}, sizes: new Map(), wrong: {}, look: null};
        self.over = overlay();
        self.warning = element('p', {class: 'note', role: 'status'});
        self.lacks = element('p', {class: 'note', role: 'status', hidden: ''});
        self.view = view(store);
        self.want = Object.fromEntries(['A', 'B', 'D'].map(k =>
            [k, fetch.pictures((wish, picture) => take(self, k, wish, picture), (_, error) => fail(self, k, error))]));
        const ask = fetch.newest((x, y) => values(self, x, y));
        self.stage = glintStage.stage({title: 'Picture', pictures: pictures(self)}, glintParts.page(), {
            values: ask, pick: (x, y) => pick(self, x, y), over: self.over.e,
            change: look => { self.look = look; store.setLook(look); refresh(self); },
            state: {mode: store.look.mode || 'slider', zoom: store.look.zoom || 0},
        });
        self.look = {mode: store.look.mode || 'slider', zoom: store.look.zoom || 0};
        const e = element('section', {class: 'live-picture', 'aria-label': 'picture'}, images(store), self.view, self.warning, self.lacks, self.stage);
        for (const what of ['result', 'pinned', 'look', 'state']) store.on(what, () => refresh(self));
        for (const what of ['error', 'progress']) store.on(what, () => drawOver(self));
        store.on('truth', () => self.stage.read());
        store.on('back', () => forget(self));
        store.on('look', () => follow(self));
        let resized = 0;
        new ResizeObserver(() => { clearTimeout(resized); resized = setTimeout(() => askAll(self), RESIZE_MS); }).observe(self.stage);
        draw(self);
        refresh(self);
        return e;
    }

    /* Somebody else may set mode and zoom, too. */
    function follow(self) {
        const {mode, zoom} = self.store.look, changed = {};
        if (mode && mode !== self.look.mode) changed.mode = mode;
        if (zoom !== null && zoom !== self.look.zoom) changed.zoom = zoom;
        if (!Object.keys(changed).length) return;
        self.look = {...self.look, ...changed};
        self.stage.set(changed);
        refresh(self);
    }

    function path(what, words, look) {
        const query = look ? view.query(look) : new URLSearchParams();
        for (const [key, value] of Object.entries(words)) query.set(key, value);
        query.set('format', 'raw');
        return `/api/v1/${what}?${query}`;
    }

    /* Texels that the screen has no room for need not be sent. */
    function few(self, image) {
        const room = self.stage.room(), every = Math.floor(image.width / room);
        return room && every > 1 && !image.cube ? {every: Math.min(every, 64)} : {};
    }

    /* The size of an image, which the picture of a cube map is not. */
    const sizeOfPicture = ({head, image}) => image.cube ? [head.width, head.height] : [image.width, image.height];

    function refresh(self) {
        askAll(self);
        mark(self);
        drawOver(self);
    }

    /* Asks for what has to be there: A, then B in the colours of A, then the heat map if it is looked at. */
    function askAll(self) {
        const {result, pinned, look} = self.store, {A} = self.shown;
        const image = result && images.chosen(result, look.image);
        if (!image) return;
        request(self, 'A', {path: path('picture', {run: result.run, image: image.name, ...few(self, image)}, look), what: image.name, run: result.run, image,
            draft: result.draft, capture: result.state.capture});
        const other = pinned && images.counterpart(pinned, result, image);
        lacking(self, pinned && !other ? image : null);
        if (!other) return drop(self, 'B', 'D');
        if (self.look.mode !== HEAT) drop(self, 'D'); /* it does not follow */
        if (!A || A.image.name !== image.name) return;
        const same = A.head.range && look.low === null && look.high === null
            ? {low: A.head.range[0], high: A.head.range[1], scale: A.head.key?.scale?.log ? 'log' : 'linear'} : {};
        const what = `${pinned.result.run} ${other.name}`;
        if (self.shown.B && self.shown.B.what !== what) drop(self, 'B', 'D');
        request(self, 'B', {path: path('picture', {run: pinned.result.run, image: other.name, ...same, ...few(self, other)}, look), what,
            run: pinned.result.run, image: other, title: pinned.title});
        if (self.look.mode !== HEAT) return;
        const named = other.name === A.image.name ? {} : {other_image: other.name};
        request(self, 'D', {path: path('difference', {run: A.run, other: pinned.result.run, image: A.image.name, ...named}, view.heatOf(look)),
            what: `${pinned.result.run} ${A.image.name}`});
    }

    /* What is shown of something else than what is asked for goes at once, and is no longer asked for. */
    function drop(self, ...which) {
        const had = which.some(k => self.shown[k]);
        for (const k of which) { request(self, k, null); self.shown[k] = null; }
        if (had) draw(self);
    }

    /* All is asked for again, and stays until it is answered. */
    function forget(self) {
        for (const k of ['A', 'B', 'D']) {
            request(self, k, null);
            if (self.shown[k]) self.shown[k].path = null;
        }
    }

    /* B has nothing to stand beside A's image, and what it could stand beside is a click away. */
    function lacking(self, image) {
        const {store: {pinned, result}, lacks} = self, name = image && glintParts.list(pinned.result.compares).find(n => result.images.some(i => i.name === n));
        const said = image ? `B, ${pinned.title}, ${pinned.of ? 'is not comparable with' : 'has no image'} ${image.name}.` : '';
        lacks.hidden = !said;
        if (lacks.dataset.said === said) return;
        lacks.dataset.said = said;
        lacks.replaceChildren(glintChart.text(said), ' ',
            name ? element('button', {type: 'button', click: () => self.store.setLook({image: name})}, `Show ${name}`) : '');
    }

    /* What is shown already, and what is wanted no more, is not wrong. */
    function request(self, which, wanted) {
        if (!wanted || self.shown[which]?.path === wanted.path) self.wrong[which] = null;
        self.want[which](wanted);
    }

    function take(self, which, wish, picture) {
        self.shown[which] = {...wish, ...picture};
        self.wrong[which] = null;
        if (which === 'A') {
            if (!wish.draft) self.sizes.set(`${wish.capture} ${wish.what}`, sizeOfPicture(self.shown.A));
            if (self.shown.A?.image.name !== self.last) self.notOfFrame = '';
            self.last = wish.image.name;
            if (self.shown.D && self.shown.D.what.split(' ')[1] !== wish.what) self.shown.D = null;
        }
        draw(self);
        refresh(self);
    }

    function drawOver(self) { self.over.draw(self.store, self.wrong, !!self.store.result && !self.shown.A && !self.wrong.A, !!self.shown.A?.draft); }

    function fail(self, which, error) {
        self.wrong[which] = error.message;
        drawOver(self);
    }

    /* The size that A stands for: a draft is shown as large as the whole picture. */
    function sizeOf({shown: {A}, sizes, store}) {
        if (!A) return frameOf(store);
        const own = sizeOfPicture(A), draft = A.draft && store.registry.captures[store.state.capture]?.draft;
        if (!A.draft) return own;
        return sizes.get(`${A.capture} ${A.what}`) || (draft && own[0] === draft[0] && own[1] === draft[1] ? frameOf(store) : own);
    }

    function pictures(self) {
        const {A, B, D} = self.shown, {pinned} = self.store, size = sizeOf(self);
        const shown = (k, p) => ({caption: k, pixels: p ? p.pixels : null, key: p?.head.key || null, size});
        return [shown('A', A), ...(pinned && self.lacks.hidden ? [shown(`B: ${pinned.title}`, B), {...shown('Heat map', D), alone: true}] : [])];
    }

    function draw(self) {
        const {A, D} = self.shown;
        self.stage.update(pictures(self));
        self.view.draw(A && A.head, self.look.mode === HEAT && D ? D.head : null);
        drawWarning(self);
        drawOver(self);
        mark(self);
    }

    function drawWarning(self) {
        self.warning.textContent = [warningOf(self.shown), self.notOfFrame].filter(t => t).join('\n');
        self.warning.hidden = !self.warning.textContent;
    }

    /* ---- Pixels ---- */

    /* The truth of an image of the effect: values of other units beside it would say nothing. */
    function truthOf(truth, A) {
        const image = truth?.result.images.find(i => i.name === truth.result.picture);
        return image && A?.image.channels.some(c => image.channels.includes(c)) ? {run: truth.result.run, image} : null;
    }

    async function values(self, x, y) {
        const {A, B} = self.shown, {truth} = self.store;
        const of = [['A', A], ['B', B], [truth?.result.picture, truthOf(truth, A)]]
            .filter(([, p]) => p).map(([caption, p]) => ({caption, run: p.run, image: p.image.name, b: caption === 'B'}));
        if (!A) return null;
        try {
            const answer = await api.post('/api/v1/values', {x, y, size: sizeOf(self), of: of.map(({run, image}) => ({run, image}))});
            return valueTable(of, answer.values, x, y);
        } catch (error) {
            return {title: `${x},${y}`, channels: [], unit: '', rows: [[error.message, []]]};
        }
    }

    function pick(self, x, y) {
        const frame = frameOf(self.store), size = sizeOf(self);
        self.notOfFrame = isOfFrame(frame, size) ? '' : 'Pixels of this image are no pixels of the frame: there is nothing to probe.';
        drawWarning(self);
        if (self.notOfFrame) return;
        self.store.setLook({x: between(x, size[0], frame[0]), y: between(y, size[1], frame[1])});
    }

    function mark(self) {
        const {look: {x, y}} = self.store, frame = frameOf(self.store), size = sizeOf(self);
        if (x === null || x === undefined || y === null || y === undefined || !isOfFrame(frame, size)) self.stage.mark(-1, -1);
        else self.stage.mark(between(x, frame[0], size[0]), between(y, frame[1], size[1]));
    }

    return Object.assign(make, {HEAT});
})();
