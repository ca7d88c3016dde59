/* The bar above the page: preset, undo and redo, B, what the replay does; and below it what went wrong.
   glintLive.bar(store, buttons), glintLive.notes(store) and glintLive.warnings(store) are elements. */
glintLive.bar = (function () {
    'use strict';
    const {element, list} = glintParts, {store: {bare}} = glintLive;

    function presetChooser(store) {
        const {presets} = store.registry;
        const select = element('select', {id: 'preset', 'aria-label': 'preset', change: () => store.change(s => bare(s.capture, select.value))},
            ...presets.map(p => element('option', {value: p.name, title: glintChart.text(p.title)}, p.name)));
        const update = () => {
            select.value = store.state.preset;
            select.title = glintChart.text(presets.find(p => p.name === store.state.preset)?.title);
        };
        store.on('state', update);
        update();
        return element('label', null, 'Preset ', select);
    }

    /* B: a menu of what can be pinned, and what is. */
    function pinChooser(store) {
        const select = element('select', {id: 'pin', 'aria-label': 'what B is', title: 'what A is compared with', change: () => choose(select.value)});
        const swap = element('button', {type: 'button', id: 'swap', title: 'swap A and B (x)', click: () => store.swap()}, 'Swap');
        let shown = null;

        function choose(value) {
            const [kind, name] = JSON.parse(value);
            if (kind === 'none') store.unpin();
            else if (kind === 'now') store.pinState(store.state);
            else if (kind === 'bare') store.pinState(bare(store.state.capture, name), name);
            else if (kind === 'answer') store.pinAnswer(name, store.effect, name === 'truth' ? 'truth' : 'reference');
            update();
        }
        function update() {
            const {pinned, registry, state, effect} = store, truth = list(registry.captures[state.capture]?.truth).includes(effect);
            const key = JSON.stringify([pinned?.title, state.preset, effect, truth]);
            swap.disabled = !pinned || !!pinned.of || !store.result || store.result.draft || store.result.quick;
            if (key === shown && select.selectedIndex === 0) return;
            shown = key;
            const option = (kind, name, text) => element('option', {value: JSON.stringify([kind, name])}, text);
            const group = (label, options) => element('optgroup', {label}, ...options);
            select.replaceChildren(pinned ? option('kept', '', pinned.title) : option('none', '', 'nothing'),
                ...(pinned ? [option('none', '', 'nothing')] : []), option('now', '', 'this state'),
                ...(effect ? [group('what it should be', [...(truth ? [option('answer', 'truth', 'truth of the capture')] : []),
                    option('answer', 'reference', registry.reference ? 'reference run' : 'reference (traced now)')])] : []),
                group('a preset', registry.presets.map(p => option('bare', p.name, p.name))));
            select.selectedIndex = 0;
        }
        for (const on of ['pinned', 'state', 'effect', 'result', 'truth']) store.on(on, update);
        update();
        return [element('label', null, 'B ', select), swap];
    }

    /* How long it took says little without how much was to be done. */
    function replayed({size, seconds, passes}) {
        const all = list(passes).filter(p => p.ran), run = all.filter(p => !p.cached).length;
        return `${size.join(' \u00d7 ')}: ${run} of ${all.length} passes run in ${glintChart.number(+(1000 * seconds).toPrecision(3))} ms`;
    }

    function status(store) {
        const meter = element('progress', {max: 1, value: 0, 'aria-label': 'progress of the replay'}), text = element('span', {role: 'status'});
        const update = () => {
            const {running, result, progress} = store;
            meter.classList.toggle('idle', !running && !progress);
            if (progress && Number.isFinite(progress.done)) meter.value = progress.done; else if (running) meter.removeAttribute('value'); else meter.value = 0;
            const what = progress?.what ? glintChart.text(progress.what) : running === 'draft' ? 'draft' : 'replaying';
            const besides = running ? [] : store.besides;
            text.textContent = running || progress ? `${besides.length ? `${besides.join(', ')}: ` : ''}${what} \u2026`
                : besides.length ? `${besides.join(', ')} \u2026` : result ? replayed(result) : '';
            document.documentElement.dataset.busy = running || 'no';
        };
        for (const on of ['progress', 'result', 'idle']) store.on(on, update);
        return element('span', {class: 'status'}, meter, text);
    }

    return function (store, buttons) {
        const step = (id, text, title, go) => element('button', {type: 'button', id, title, 'aria-label': title, click: go}, text);
        const undo = step('undo', '\u21b6', 'undo (Ctrl+Z)', () => store.undo()), redo = step('redo', '\u21b7', 'redo (Ctrl+Shift+Z)', () => store.redo());
        const update = () => { undo.disabled = !store.canUndo(); redo.disabled = !store.canRedo(); };
        store.on('state', update);
        update();
        const {registry} = store, [capture] = registry.captures;
        const of = registry.captures.length > 1 ? `${registry.captures.length} captures` : capture?.name, together = (...parts) => element('span', {class: 'together'}, ...parts);
        return element('header', {class: 'bar'},
            element('h1', {title: glintChart.text(`${registry.tool}, ${registry.device?.name}`)}, 'glint live', element('span', null, of)),
            presetChooser(store), together(undo, redo), together(...pinChooser(store)), status(store), element('span', {class: 'ends'}, ...buttons));
    };
})();

glintLive.notes = (function () {
    'use strict';
    const {element, list} = glintParts;

    function badTable(store, values) {
        const button = v => element('button', {type: 'button', title: 'show this pixel', click: () => store.setLook({image: v.image, x: v.x, y: v.y})}, `${v.x}, ${v.y}`);
        const counts = v => [v.not_finite ? `${v.not_finite} not finite` : '', v.clamped ? `${v.clamped} clamped` : ''].filter(t => t).join(', ');
        const row = v => element('tr', null, ...[v.slot, v.image, v.channel, button(v), String(v.value), counts(v)].map(c => element('td', null, c)));
        const heads = ['pass', 'image', 'channel', 'pixel', 'value', 'how many'].map(t => element('th', {scope: 'col'}, t));
        return element('div', {class: 'scroll'}, element('table', null, element('thead', null, element('tr', null, ...heads)), element('tbody', null, ...values.map(row))));
    }

    /* What the replay warns of. */
    glintLive.warnings = function (store) {
        const box = element('details', {class: 'warnings', hidden: ''}, element('summary'));
        const some = (n, word) => n ? `${n} ${word}${n > 1 ? 's' : ''}` : null;
        let shown = '';
        store.on('result', () => {
            const said = list(store.result.warnings), bad = list(store.result.bad_values), key = JSON.stringify([said, bad]);
            if (key === shown) return;
            shown = key;
            box.hidden = !said.length && !bad.length;
            box.firstChild.textContent = [some(said.length, 'warning'), bad.length ? `${some(bad.length, 'channel')} with values that are not finite` : null].filter(t => t).join(', ');
            box.replaceChildren(box.firstChild, ...said.map(t => element('p', null, t)), ...(bad.length ? [badTable(store, bad)] : []));
        });
        return box;
    };

    /* The error, and news of the server. */
    return function (store) {
        const gone = element('div', {class: 'message error', role: 'alert', hidden: ''}, 'The server does not answer. The page goes on when it is back.');
        const error = element('div', {class: 'message error', role: 'alert', hidden: ''}), news = element('div', {class: 'news', role: 'status'});
        const close = (label, f) => element('button', {type: 'button', class: 'close', 'aria-label': label, title: label, click: f}, '\u00d7');
        /* What was refused is said at its control, where that is on the page; what failed is said over the picture. */
        const rowOf = name => [...document.querySelectorAll('.parameter')].find(row => row.dataset.name === name);
        const standsAtControl = () => store.refusal.names.some(name => rowOf(name)?.offsetParent);
        store.on('refused', () => {
            error.hidden = !store.refusal || standsAtControl();
            error.replaceChildren(...(error.hidden ? [] : [element('p', null, store.refusal.message), close('dismiss the message', store.clearRefusal)]));
        });
        store.notice = text => {
            const line = element('div', {class: 'message'}, element('p', null, text), close('dismiss the notice', () => line.remove()));
            news.append(line);
            while (news.children.length > 3) news.firstChild.remove();
        };
        store.setGone = yes => { gone.hidden = !yes; };
        return element('div', {class: 'notes'}, gone, error, news);
    };
})();
