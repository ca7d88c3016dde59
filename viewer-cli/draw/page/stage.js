/* A stage of page.h: pictures over each other, a slider between two of them, both beside each other or in turns, one alone;
   the key to their colours, and the values of the pixel that is pointed at or reached by keys. */
const glintStage = (function () {
    'use strict';
    const {element, list} = glintParts;
    const TURN_MS = 500;
    const stages = [];

    /* ---- Values ---- */

    /* The bytes of page_values, inflated: planes of like bytes, each less the one to its left. */
    async function inflate(values) {
        const packed = Uint8Array.from(atob(values.data), c => c.charCodeAt(0));
        const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
        const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
        const width = Math.ceil(values.width / values.every);
        for (let row = 0; row < bytes.length; row += width)
            for (let i = row + 1; i < row + width; i++) bytes[i] += bytes[i - 1];
        return bytes;
    }

    /* {channel: value} at a pixel, or at the kept one before it. */
    function valuesAt(values, bytes, x, y) {
        const width = Math.ceil(values.width / values.every), height = Math.ceil(values.height / values.every);
        const at = Math.floor(y / values.every) * width + Math.floor(x / values.every), plane = width * height;
        const bits = new DataView(new ArrayBuffer(4));
        return Object.fromEntries(values.channels.map((name, k) => {
            for (let b = 0; b < 4; b++) bits.setUint8(3 - b, bytes[(4 * k + b) * plane + at]);
            return [name, bits.getFloat32(0)];
        }));
    }

    /* What a value says: the name that it has, else a number, else what is there instead of one. */
    function words(v, names) {
        if (v === undefined) return '\u2013';
        if (Number.isNaN(v)) return 'not a number';
        if (!Number.isFinite(v)) return v > 0 ? 'infinite' : 'no value';
        const number = String(+v.toPrecision(6)).replace('-', '\u2212'), name = names?.[String(v)];
        return typeof name === 'string' ? `${number}: ${glintChart.text(name)}` : number;
    }

    /* b less a, of values that need not be finite. */
    function change(a, b, names) {
        if (Object.is(a, b)) return '0';
        if (names && Object.keys(names).length) return a === b ? '0' : 'another';
        if (Number.isFinite(a) && Number.isFinite(b)) return words(b - a);
        return Number.isFinite(a) || Number.isFinite(b) ? 'only one is finite' : 'not comparable';
    }

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

    /* ---- One stage ---- */

    function stage(block, own) {
        const {sourceOf} = own;
        const pictures = list(block.pictures).filter(p => p && sourceOf(p));
        if (!pictures.length) return null;
        const pairs = pictures.filter(p => !p.alone), alone = pictures.filter(p => p.alone);
        const name = glintChart.text(block.title);
        const state = {mode: pairs.length > 1 ? 'slider' : 'left', left: 0, right: Math.max(0, pairs.length - 1), share: 50, zoom: 0, turn: 0, x: -1, y: -1};
        const kept = `${document.title}|${name}|${stages.filter(s => s.name === name).length}`;
        let timer = 0;
        stages.push({name, keep: () => store(kept, state)});
        Object.assign(state, recall(kept));
        if (!pairs[state.left] || !pairs[state.right]) state.left = state.right = 0;

        const images = [element('img', {alt: ''}), element('img', {alt: ''})];
        const tags = [element('span', {class: 'tag'}), element('span', {class: 'tag right'})];
        const line = element('i', {class: 'line'}), cross = element('i', {class: 'cross'});
        const frame = element('div', {class: 'frame', tabindex: 0, role: 'group',
            'aria-label': `${name}: arrow keys go from pixel to pixel, Shift by ten, Space shows the other picture`}, ...images, line, ...tags, cross);
        const scroll = element('div', {class: 'stage-scroll'}, frame);
        const slider = element('input', {type: 'range', min: 0, max: 100, step: 0.1, 'aria-label': `${name}: where the first picture ends`});
        const key = element('div');
        const readout = element('div', {class: 'readout', 'aria-live': 'polite'});

        function chooser(which, label) {
            const select = element('select', {'aria-label': label}, ...pairs.map((p, i) => element('option', {value: i}, p.caption)));
            select.value = state[which];
            select.addEventListener('change', () => { state[which] = +select.value; draw(); });
            return select;
        }

        const modes = [...(pairs.length > 1 ? [['slider', 'Slider'], ['beside', 'Side by side'], ['flicker', 'Flicker']] : []),
            ['left', glintChart.text(pairs.length === 2 ? pairs[0].caption : 'First alone')],
            ...(pairs.length > 1 ? [['right', glintChart.text(pairs.length === 2 ? pairs[1].caption : 'Second alone')]] : []),
            ...alone.map((p, i) => [`alone${i}`, glintChart.text(p.caption)])];
        const buttons = modes.map(([mode, text]) => {
            const button = element('button', {type: 'button'}, text);
            button.addEventListener('click', () => { state.mode = mode; draw(); });
            return button;
        });
        const zoom = element('select', {'aria-label': 'size'}, ...['fit', '1\u00d7', '2\u00d7', '4\u00d7', '8\u00d7'].map((t, i) => element('option', {value: i}, t)));
        zoom.addEventListener('change', () => { state.zoom = +zoom.value; draw(); });

        function shown() {
            const match = /^alone(\d+)$/.exec(state.mode);
            return match ? [alone[+match[1]], null] : state.mode === 'right' ? [pairs[state.right], null]
                : state.mode === 'left' ? [pairs[state.left], null] : [pairs[state.left], pairs[state.right]];
        }

        function draw() {
            if (!modes.some(([mode]) => mode === state.mode)) state.mode = modes[0][0];
            const two = shown();
            buttons.forEach((b, i) => b.setAttribute('aria-pressed', String(modes[i][0] === state.mode)));
            zoom.value = state.zoom;
            frame.className = `frame ${state.mode}`;
            two.forEach((p, i) => {
                images[i].hidden = tags[i].hidden = !p;
                if (!p) return;
                if (images[i].src !== sourceOf(p)) images[i].src = sourceOf(p);
                images[i].alt = tags[i].textContent = glintChart.text(p.caption);
            });
            const keys = two.filter(p => p && p.key).map(p => p.key);
            key.replaceChildren(...(keys.length ? [keyElement(keys)] : []));
            slider.hidden = line.hidden = state.mode !== 'slider';
            slide(state.share);
            clearInterval(timer);
            if (state.mode === 'flicker') timer = setInterval(turn, TURN_MS);
            flip();
            size();
            point();
        }

        /* As wide as its column, or by whole pixels of the values. */
        function size() {
            const values = pictures.map(p => p.values).find(v => v);
            const two = state.mode === 'beside' ? 2 : 1, width = values ? values.width : images[0].naturalWidth || 16;
            const height = values ? values.height : images[0].naturalHeight || 9;
            frame.style.width = slider.style.width = state.zoom ? `${two * width * 2 ** (state.zoom - 1)}px`
                : `min(100%, ${(two * 78 * width / height).toFixed(1)}vh)`;
        }

        function slide(share) {
            state.share = Math.min(100, Math.max(0, share));
            slider.value = state.share;
            images[1].style.clipPath = state.mode === 'slider' ? `inset(0 0 0 ${state.share}%)` : '';
            line.style.left = `${state.share}%`;
        }

        function flip() {
            const second = state.mode === 'flicker' && state.turn % 2 === 1;
            images[1].style.visibility = tags[1].style.visibility = state.mode === 'flicker' && !second ? 'hidden' : '';
            tags[0].style.visibility = second ? 'hidden' : '';
        }

        function turn() { state.turn++; flip(); }

        /* ---- The pixel ---- */

        const readable = pictures.filter(p => p.values && p.values.data);

        async function point() {
            const v = readable[0]?.values;
            if (!v || state.x < 0) {
                cross.hidden = true;
                readout.replaceChildren(readable.length ? element('p', {class: 'faint'}, 'Point at a pixel, or go there with the arrow keys, to read its values.') : '');
                return;
            }
            state.x = Math.min(v.width - 1, state.x);
            state.y = Math.min(v.height - 1, state.y);
            const half = state.mode === 'beside' ? 0.5 : 1, x = state.x, y = state.y;
            cross.hidden = false;
            cross.style.left = `${100 * half * (x + 0.5) / v.width}%`;
            cross.style.top = `${100 * (y + 0.5) / v.height}%`;
            const rows = await Promise.all(readable.map(async p => {
                if (!p.bytes) p.bytes = inflate(p.values);
                return valuesAt(p.values, await p.bytes, x, y);
            }));
            if (x !== state.x || y !== state.y) return;
            readout.replaceChildren(table(v, rows, x, y));
        }

        function table(v, rows, x, y) {
            const left = readable.indexOf(pairs[state.left]), right = readable.indexOf(pairs[state.right]);
            const both = left >= 0 && right >= 0 && left !== right;
            const lines = rows.map((row, i) => [readable[i].caption, v.channels.map(c => words(row[c], v.names))]);
            if (both) lines.push([`${glintChart.text(pairs[state.right].caption)} \u2212 ${glintChart.text(pairs[state.left].caption)}`,
                v.channels.map(c => c in rows[left] && c in rows[right] ? change(rows[left][c], rows[right][c], v.names) : '\u2013')]);
            const e = v.every > 1 ? ` (of ${x - x % v.every},${y - y % v.every}: one of ${v.every} \u00d7 ${v.every} is kept)` : '';
            return element('table', null,
                element('thead', null, element('tr', null, element('th', {scope: 'col'}, `${x},${y}${e}`),
                    ...v.channels.map(c => element('th', {scope: 'col', class: 'number'}, c)), element('th', null, v.unit || ''))),
                element('tbody', null, ...lines.map(([caption, row]) => element('tr', null, element('th', {scope: 'row'}, caption),
                    ...row.map(text => element('td', {class: 'number'}, text)), element('td')))));
        }

        function place(event) {
            const v = readable[0]?.values, box = frame.getBoundingClientRect();
            const two = state.mode === 'beside' ? 2 : 1;
            let x = (event.clientX - box.left) / box.width * two;
            if (x >= 1 && two === 2) x -= 1;
            if (!v) return;
            state.x = Math.max(0, Math.floor(x * v.width));
            state.y = Math.max(0, Math.floor((event.clientY - box.top) / box.height * v.height));
            point();
        }

        frame.addEventListener('pointermove', event => {
            place(event);
            if (state.mode !== 'slider' || !(event.buttons & 1)) return;
            const box = frame.getBoundingClientRect();
            slide(100 * (event.clientX - box.left) / box.width);
        });
        frame.addEventListener('pointerdown', event => {
            if (state.mode !== 'slider') return;
            frame.setPointerCapture(event.pointerId);
            const box = frame.getBoundingClientRect();
            slide(100 * (event.clientX - box.left) / box.width);
        });
        frame.addEventListener('keydown', event => {
            const step = {ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1]}[event.key];
            if (step) {
                const by = event.shiftKey ? 10 : 1, v = readable[0]?.values;
                if (!v) return;
                if (state.x < 0) { state.x = Math.floor(v.width / 2); state.y = Math.floor(v.height / 2); }
                else { state.x = Math.max(0, state.x + by * step[0]); state.y = Math.max(0, state.y + by * step[1]); }
                point();
            } else if (event.key === ' ') {
                if (state.mode === 'flicker') turn();
                else if (pairs.length > 1) { state.mode = state.mode === 'right' ? 'left' : 'right'; draw(); }
            } else return;
            event.preventDefault();
        });
        slider.addEventListener('input', () => slide(+slider.value));
        images[0].addEventListener('load', size);

        const result = element('section', {class: 'stage'},
            element('div', {class: 'bar', role: 'toolbar', 'aria-label': name}, ...buttons,
                ...(pairs.length > 2 ? [chooser('left', 'first picture'), chooser('right', 'second picture')] : []), zoom),
            slider, scroll, key, readout);
        draw();
        return result;
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
