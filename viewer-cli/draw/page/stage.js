/* A stage of page.h: pictures over each other, a slider between two of them, both beside each other or in turns, one alone;
   the key to their colours, and the values of the pixel that is pointed at or reached by keys. */
const glintStage = (function () {
    'use strict';
    const {element, list} = glintParts;
    const TURN_MS = 500;
    const DRAG_PX = 4; /* a press that moves less is a click */
    const stages = [];

    /* ---- The key to the colours ---- */

    const COLOR = /^#[0-9a-f]{6}$/;

    function scaleElement(scale) {
        const colors = list(scale.colors).filter(c => COLOR.test(c));
        const {low, high} = scale, at = t => scale.log ? low * (high / low) ** t : low + (high - low) * t;
        if (colors.length < 2 || !Number.isFinite(low) || !(high > low) || (scale.log && !(low > 0))) return null;
        const bar = element('div', {class: 'scale'});
        bar.style.background = `linear-gradient(to right, ${colors.join()})`;
        return element('div', null, bar, element('div', {class: 'ticks'}, ...[0, 0.25, 0.5, 0.75, 1].map(t =>
            element('span', null, glintChart.number(+at(t).toPrecision(3))))));
    }

    /* Of one or two pictures, whose shares stand behind each other. */
    function keyElement(keys) {
        const first = keys[0], items = new Map();
        keys.forEach((key, k) => list(key.items).forEach(i => {
            if (!i || !COLOR.test(i.color)) return;
            if (!items.has(i.text)) items.set(i.text, {color: i.color, shares: keys.map(() => 0), known: false});
            if (Number.isFinite(i.share)) Object.assign(items.get(i.text), {known: true}).shares[k] = i.share;
        }));
        return element('div', {class: 'key'}, element('div', {class: 'faint'}, `${glintChart.text(first.title)}${first.scale?.log ? ', logarithmic' : ''}`),
            first.scale ? scaleElement(first.scale) : null,
            element('div', {class: 'items'}, ...[...items].map(([text, {color, shares, known}]) => {
                const patch = element('i');
                patch.style.background = color;
                return element('span', null, patch, text, known ? ` ${shares.map(s => `${(100 * s).toFixed(1)} %`).join(' \u00b7 ')}` : '');
            })));
    }

    /* ---- One of the two pictures: an <img>, or a <canvas> for pixels ---- */

    function layer() {
        const image = element('img', {alt: '', class: 'layer'}), canvas = element('canvas', {role: 'img', class: 'layer'});
        const self = {image, e: image, shown: null, tag: element('span', {class: 'tag'})};

        function paint(pixels) {
            if (!pixels || self.shown === pixels) return;
            canvas.width = pixels.width;
            canvas.height = pixels.height;
            const context = canvas.getContext('2d');
            if (pixels instanceof ImageData) context.putImageData(pixels, 0, 0);
            else context.drawImage(pixels, 0, 0);
            self.shown = pixels;
        }

        self.show = (p, source) => {
            const next = p && p.pixels !== undefined ? canvas : image;
            if (next !== self.e) self.e.replaceWith(next);
            self.e = next;
            self.tag.hidden = !p;
            self.e.hidden = !p || p.pixels === null;
            if (!p) return;
            if (next === canvas) paint(p.pixels);
            else if (image.src !== source) image.src = source;
            self.tag.textContent = glintChart.text(p.caption);
            self.e.setAttribute(next === canvas ? 'aria-label' : 'alt', self.tag.textContent);
        };
        return self;
    }

    /* ---- One stage ---- */

    const isPicture = (p, sourceOf) => p && (p.pixels !== undefined || sourceOf(p));

    /* The ways to look at pairs of pictures and at those that stand alone: [mode, its name]. */
    function modesOf(pairs, alone) {
        const several = pairs.length > 1, two = pairs.length === 2;
        return [...(several ? [['slider', 'Slider'], ['beside', 'Side by side'], ['flicker', 'Flicker']] : []),
            ...(pairs.length ? [['left', glintChart.text(two ? pairs[0].caption : 'First alone')]] : []),
            ...(several ? [['right', glintChart.text(two ? pairs[1].caption : 'Second alone')]] : []),
            ...alone.map((p, i) => [`alone${i}`, glintChart.text(p.caption)])];
    }

    /* A SHOWN of a script may have "pixels" instead of "file": an ImageData or a canvas, or null until there are some; and "size": the
       width and height that it stands for, if it has fewer pixels than that. `hooks`, all of which may be left out:
         values(x, y)   a promise of what glintValues.table shows of a pixel, or of null for what was there before
         pick(x, y)     a click on a pixel, or Enter
         change(state)  {mode, zoom} have been changed by somebody
         state          {mode, zoom} to begin with
         over           an element that lies over the pictures
       The element has update(pictures), which keeps all that somebody has chosen, mark(x, y), for a pixel to be marked or -1, set({mode,
       zoom}), and pointed(), the pixel [x, y] that is pointed at or null. */
    function stage(block, own, hooks = {}) {
        if (!list(block.pictures).some(p => isPicture(p, own.sourceOf))) return null;
        const name = glintChart.text(block.title), kept = `${document.title}|${name}|${stages.filter(s => s.name === name).length}`;
        const state = {mode: 'slider', left: 0, right: -1, share: 50, zoom: 0, turn: 0, x: -1, y: -1, ...recall(kept), ...hooks.state};
        const self = {own, hooks, name, state, pictures: [], pairs: [], alone: [], readable: [], modes: [], picked: [-1, -1], timer: 0, asked: 0};
        stages.push({name, keep: () => store(kept, state)});
        build(self);
        self.zoom = glintZoom.create(self.frame, self.scroll, {
            size: () => grid(self) || natural(self), across: () => self.mode() === 'beside' ? 2 : 1, resize: zoom => size(self, zoom),
            fixed: () => state.x < 0 || !grid(self) ? null : placeOf(self, state.x, state.y),
            changed: () => { state.zoom = self.zoom.zoom; drawZoom(self); changed(self); },
        });
        self.zoom.start(state.zoom);
        listen(self);
        take(self, block.pictures);
        self.result.update = pictures => take(self, pictures);
        self.result.mark = (x, y) => { self.picked = [x, y]; drawMarks(self); };
        self.result.pointed = () => state.x < 0 ? null : [state.x, state.y];
        self.result.read = () => point(self);
        self.result.room = () => room(self);
        self.result.set = ({mode, zoom}) => {
            if (mode) state.mode = mode;
            if (zoom !== undefined) self.zoom.set(zoom);
            draw(self);
        };
        return self.result;
    }

    function build(self) {
        const {name, hooks} = self;
        self.layers = [layer(), layer()];
        self.layers[1].tag.classList.add('right');
        Object.assign(self, {line: element('i', {class: 'line'}), cross: element('i', {class: 'cross'}), mark: element('i', {class: 'cross picked'})});
        self.frame = element('div', {class: 'frame', tabindex: 0, role: 'group',
            'aria-label': `${name}: arrow keys go from pixel to pixel, Shift by ten, Space shows the other picture, plus and minus zoom${hooks.pick ? ', Enter chooses the pixel' : ''}`},
        ...self.layers.map(l => l.e), self.line, ...self.layers.map(l => l.tag), self.cross, self.mark);
        self.scroll = element('div', {class: 'stage-scroll'}, self.frame);
        self.slider = element('input', {type: 'range', min: 0, max: 100, step: 0.1, 'aria-label': `${name}: where the first picture ends`});
        self.key = element('div');
        self.readout = element('div', {class: 'readout', 'aria-live': 'polite'});
        self.bar = element('div', {class: 'bar', role: 'toolbar', 'aria-label': name});
        self.sizes = element('select', {'aria-label': 'size', change: () => self.zoom.set(+self.sizes.value)},
            ...glintZoom.STEPS.map((t, i) => element('option', {value: i}, t)));
        self.view = element('div', {class: 'stage-view'}, self.scroll, hooks.over);
        self.result = element('section', {class: 'stage'}, self.bar, self.slider, self.view, self.key, self.readout);
        self.mode = () => (self.modes.find(([mode]) => mode === self.state.mode) || self.modes[0])[0];
    }

    function changed({hooks, state}) { if (hooks.change) hooks.change({mode: state.mode, zoom: state.zoom}); }

    /* ---- Pictures, and the buttons that choose among them ---- */

    function take(self, pictures) {
        const {state, own} = self;
        self.pictures = list(pictures).filter(p => isPicture(p, own.sourceOf));
        self.pairs = self.pictures.filter(p => !p.alone);
        self.alone = self.pictures.filter(p => p.alone);
        self.readable = self.pictures.filter(p => p.values && p.values.data);
        if (!self.pairs[state.left] || !self.pairs[rightOf(self)]) Object.assign(state, {left: 0, right: -1});
        const modes = modesOf(self.pairs, self.alone), names = JSON.stringify([modes, self.pairs.map(p => p.caption)]);
        self.modes = modes;
        if (names !== self.names) drawBar(self);
        self.names = names;
        draw(self);
    }

    /* The second picture is the last one until another is chosen. */
    function rightOf({state, pairs}) { return state.right < 0 ? Math.max(0, pairs.length - 1) : state.right; }

    function chooser(self, which, label) {
        const select = element('select', {'aria-label': label}, ...self.pairs.map((p, i) => element('option', {value: i}, p.caption)));
        select.value = which === 'right' ? rightOf(self) : self.state.left;
        select.addEventListener('change', () => { self.state[which] = +select.value; draw(self); });
        return select;
    }

    function drawBar(self) {
        const focused = self.bar.contains(document.activeElement) ? document.activeElement : null;
        self.buttons = self.modes.map(([mode, text]) => element('button', {type: 'button', 'data-mode': mode, click: () => choose(self, mode)}, text));
        self.bar.replaceChildren(...self.buttons,
            ...(self.pairs.length > 2 ? [chooser(self, 'left', 'first picture'), chooser(self, 'right', 'second picture')] : []), self.sizes);
        if (focused) (self.buttons.find(b => b.dataset.mode === focused.dataset.mode) || (focused === self.sizes ? focused : self.buttons[0])).focus();
    }

    function choose(self, mode) {
        self.state.mode = mode;
        draw(self);
        changed(self);
    }

    function pairOf(self) { return [self.pairs[self.state.left], self.pairs[rightOf(self)]]; }

    function shown(self, mode) {
        const match = /^alone(\d+)$/.exec(mode), [left, right] = pairOf(self);
        return match ? [self.alone[+match[1]], null] : mode === 'right' ? [right, null] : mode === 'left' ? [left, null] : [left, right];
    }

    function draw(self) {
        const mode = self.mode(), two = shown(self, mode);
        self.buttons.forEach((b, i) => b.setAttribute('aria-pressed', String(self.modes[i][0] === mode)));
        self.frame.className = `frame ${mode}`;
        two.forEach((p, i) => self.layers[i].show(p, p && self.own.sourceOf(p)));
        const keys = two.filter(p => p && p.key).map(p => p.key);
        self.key.replaceChildren(...(keys.length ? [keyElement(keys)] : []));
        self.slider.hidden = self.line.hidden = mode !== 'slider';
        slide(self, self.state.share);
        clearInterval(self.timer);
        if (mode === 'flicker') self.timer = setInterval(() => turn(self), TURN_MS);
        flip(self);
        size(self, self.zoom.zoom);
        drawZoom(self);
        point(self);
    }

    function drawZoom(self) { self.sizes.value = self.zoom.zoom; }

    /* ---- Places ---- */

    /* Width and height in pixels of what values are asked of, or null if there are none. */
    function grid({readable, pictures}) {
        const v = readable[0]?.values, sized = pictures.find(p => p.size || p.pixels);
        return v ? [v.width, v.height] : sized ? sized.size || [sized.pixels.width, sized.pixels.height] : null;
    }

    function natural({pictures, layers}) {
        const v = pictures.map(p => p.values).find(v => v), {image} = layers[0];
        return v ? [v.width, v.height] : [image.naturalWidth || 16, image.naturalHeight || 9];
    }

    /* As wide as its column, or by whole pixels behind a window as high as the whole would be, so that what is zoomed stays in place. */
    /* The width on the screen of one picture, in its pixels; 0: unknown, or all of the picture's own pixels are to be seen. */
    function room(self) {
        const width = self.frame.clientWidth / (self.mode() === 'beside' ? 2 : 1);
        return self.state.zoom ? 0 : Math.round(width * devicePixelRatio);
    }

    function size(self, zoom) {
        const {frame, scroll, slider, view} = self, {scrollLeft, scrollTop} = scroll;
        const [width, height] = grid(self) || natural(self), two = self.mode() === 'beside' ? 2 : 1;
        const now = [zoom, width, height, two, view.clientWidth, innerHeight].join();
        if (now === self.sized) return;
        frame.style.aspectRatio = self.pictures.some(p => p.pixels !== undefined) ? `${two * width} / ${height}` : '';
        const fit = frame.style.width = `min(100%, ${(two * 78 * width / height).toFixed(1)}vh)`;
        const high = frame.offsetHeight;
        scroll.style.height = zoom && high ? `${high + 6}px` : '';
        frame.style.width = slider.style.width = zoom ? `${two * width * 2 ** (zoom - 1)}px` : fit;
        slider.style.maxWidth = '100%';
        Object.assign(scroll, {scrollLeft, scrollTop});
        self.sized = high ? now : null;
    }

    /* Where the middle of a pixel is in the frame, 0 to 1. */
    function placeOf(self, x, y) {
        const [width, height] = grid(self), half = self.mode() === 'beside' ? 0.5 : 1;
        return [half * (x + 0.5) / width, (y + 0.5) / height];
    }

    function slide(self, share) {
        const {state, slider, layers, line} = self;
        state.share = Math.min(100, Math.max(0, share));
        slider.value = state.share;
        layers[1].e.style.clipPath = self.mode() === 'slider' ? `inset(0 0 0 ${state.share}%)` : '';
        line.style.left = `${state.share}%`;
    }

    function flip(self) {
        const flicker = self.mode() === 'flicker', second = flicker && self.state.turn % 2 === 1;
        self.layers[1].e.style.visibility = self.layers[1].tag.style.visibility = flicker && !second ? 'hidden' : '';
        self.layers[0].tag.style.visibility = second ? 'hidden' : '';
    }

    function turn(self) { self.state.turn++; flip(self); }

    /* ---- The pixel ---- */

    function drawMark(self, e, x, y) {
        const size = grid(self);
        e.hidden = !size || x < 0 || x >= size[0] || y >= size[1];
        if (e.hidden) return;
        const [u, v] = placeOf(self, x, y);
        e.style.left = `${100 * u}%`;
        e.style.top = `${100 * v}%`;
    }

    function drawMarks(self) {
        drawMark(self, self.cross, self.state.x, self.state.y);
        drawMark(self, self.mark, ...self.picked);
    }

    async function point(self) {
        const {state, hooks, readable} = self, size = grid(self);
        if (size && state.x >= 0) {
            state.x = Math.min(size[0] - 1, state.x);
            state.y = Math.min(size[1] - 1, state.y);
        }
        drawMarks(self);
        const asked = ++self.asked;
        if (!size || state.x < 0) {
            self.readout.replaceChildren(readable.length || hooks.values ? element('p', {class: 'faint'}, 'Point at a pixel, or go there with the arrow keys, to read its values.') : '');
            return;
        }
        const {x, y} = state;
        const values = hooks.values ? await hooks.values(x, y)
            : readable.length ? await glintValues.read(readable, pairOf(self), x, y) : null;
        if (asked === self.asked && values) self.readout.replaceChildren(glintValues.table(values));
    }

    /* The pixel at a place in the window becomes the one that is pointed at. */
    function place(self, event) {
        const size = grid(self), box = self.frame.getBoundingClientRect(), two = self.mode() === 'beside' ? 2 : 1;
        let u = (event.clientX - box.left) / box.width * two;
        if (u >= 1 && two === 2) u -= 1;
        if (!size) return;
        const x = Math.max(0, Math.floor(u * size[0])), y = Math.max(0, Math.floor((event.clientY - box.top) / box.height * size[1]));
        self.state.x = Math.min(size[0] - 1, x);
        self.state.y = Math.min(size[1] - 1, y);
        point(self);
    }

    function step(self, x, y, far) {
        const {state, zoom} = self, size = grid(self), by = far ? 10 : 1;
        if (!size) return;
        if (state.x < 0) { state.x = Math.floor(size[0] / 2); state.y = Math.floor(size[1] / 2); }
        else { state.x = Math.max(0, state.x + by * x); state.y = Math.max(0, state.y + by * y); }
        point(self);
        zoom.show(...placeOf(self, state.x, state.y));
    }

    /* ---- Pointers and keys ---- */

    function listen(self) {
        const {frame, state, hooks} = self;
        /* what a press does: "slide" the line, "pan", or nothing yet */
        const press = {what: null, x: 0, y: 0, moved: false, space: false, pointed: false};

        function slideTo(event) {
            const box = frame.getBoundingClientRect();
            slide(self, 100 * (event.clientX - box.left) / box.width);
        }

        frame.addEventListener('pointermove', event => {
            if (press.what === 'pan') {
                self.zoom.move(event.clientX - press.x, event.clientY - press.y);
                Object.assign(press, {x: event.clientX, y: event.clientY, moved: true});
                return;
            }
            place(self, event);
            press.pointed = true;
            if (!(event.buttons & 1) || press.what !== 'slide') return;
            if (Math.hypot(event.clientX - press.x, event.clientY - press.y) >= DRAG_PX) press.moved = true;
            if (press.moved || !hooks.pick) slideTo(event);
        });
        frame.addEventListener('pointerdown', event => {
            const pan = event.button === 1 || (event.button === 0 && press.space);
            Object.assign(press, {what: pan ? 'pan' : event.button === 0 && self.mode() === 'slider' ? 'slide' : event.button === 0 ? 'click' : null,
                x: event.clientX, y: event.clientY, moved: false});
            if (pan) { event.preventDefault(); frame.classList.add('moving'); }
            if (pan || press.what === 'slide') frame.setPointerCapture(event.pointerId);
            if (press.what === 'slide' && !hooks.pick) slideTo(event);
        });
        frame.addEventListener('pointerup', event => {
            const picked = hooks.pick && ['slide', 'click'].includes(press.what) && !press.moved &&
                Math.hypot(event.clientX - press.x, event.clientY - press.y) < DRAG_PX;
            if (press.what === 'pan') press.space = press.space && 'moved';
            press.what = null;
            frame.classList.remove('moving');
            if (!picked) return;
            place(self, event);
            if (state.x >= 0) hooks.pick(state.x, state.y);
        });
        frame.addEventListener('pointerleave', () => {
            if (self.picked[0] < 0 || press.what || !press.pointed) return;
            [state.x, state.y] = self.picked;
            point(self);
        });
        frame.addEventListener('pointercancel', () => { press.what = null; frame.classList.remove('moving'); });
        frame.addEventListener('mousedown', event => { if (event.button === 1) event.preventDefault(); }); /* no scrolling by the browser */
        frame.addEventListener('blur', () => { press.space = false; });
        frame.addEventListener('keyup', event => {
            if (event.key !== ' ') return;
            const moved = press.space === 'moved' || press.what === 'pan';
            press.space = false;
            if (!moved) other(self);
        });
        frame.addEventListener('keydown', event => { if (key(self, press, event)) { press.pointed = false; event.preventDefault(); } });
        self.slider.addEventListener('input', () => slide(self, +self.slider.value));
        const resize = () => { self.sized = null; size(self, self.zoom.zoom); };
        self.layers[0].image.addEventListener('load', resize);
        let width = 0;
        new ResizeObserver(() => { if (self.view.clientWidth !== width) { width = self.view.clientWidth; resize(); } }).observe(self.view);
    }

    /* Shows the other picture. */
    function other(self) {
        if (self.mode() === 'flicker') turn(self);
        else if (self.pairs.length > 1) choose(self, self.mode() === 'right' ? 'left' : 'right');
    }

    /* Whether the key means something here. */
    function key(self, press, event) {
        const {hooks, state} = self, way = {ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1]}[event.key];
        if (event.ctrlKey || event.metaKey || event.altKey) return false;
        if (way) step(self, ...way, event.shiftKey);
        else if (event.key === '+' || event.key === '=') self.zoom.by(1);
        else if (event.key === '-') self.zoom.by(-1);
        else if (event.key === '0') self.zoom.set(0);
        else if (event.key === ' ') press.space = press.space || true;
        else if (event.key === 'Enter' && hooks.pick && state.x >= 0) hooks.pick(state.x, state.y);
        else return false;
        return true;
    }

    /* ---- What a page that loads itself again keeps: without storage it starts from the defaults ---- */

    function store(key, value) {
        try { sessionStorage.setItem(key, JSON.stringify(value)); } catch { /* nothing is kept */ }
    }

    function recall(key) {
        try { return JSON.parse(sessionStorage.getItem(key)) || {}; } catch { return {}; }
    }

    /* Loads the page again every so many seconds, unless it is out of sight or somebody is at work on it. */
    function refresh(seconds) {
        let busy = 0;
        for (const kind of ['pointermove', 'pointerdown', 'keydown', 'wheel']) addEventListener(kind, () => { busy = Date.now(); }, {passive: true});
        scrollTo(0, recall(`${document.title}|top`).top || 0);
        setInterval(() => {
            if (document.hidden || Date.now() - busy < 1500) return;
            stages.forEach(s => s.keep());
            store(`${document.title}|top`, {top: scrollY});
            location.reload();
        }, 1000 * seconds);
    }

    return {stage, refresh, store, recall, key: keyElement};
})();
