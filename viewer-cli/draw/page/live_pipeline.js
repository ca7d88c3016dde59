/* The panel of the pipeline: slots in the order in which they run, each with variant, switch, time and fetches, and its parameters.
   All of it comes from the registry and from what the server says of the state. glintLive.pipeline(store) is the element. */
glintLive.pipeline = (function () {
    'use strict';
    const {element, list} = glintParts, {store: {bare}} = glintLive;
    const NONE = 'none'; /* as in --use SLOT=none */
    const KEPT = 'up to date', SKIPPED = 'skipped: what reads its images gets fallback values';

    function milliseconds(ns) { return `${glintChart.number(+(ns / 1e6).toPrecision(3))} ms`; }

    function count(v) {
        const [size, word] = v >= 1e9 ? [1e9, ' G'] : v >= 1e6 ? [1e6, ' M'] : v >= 1e3 ? [1e3, ' k'] : [1, ''];
        return `${+(v / size).toPrecision(3)}${word}`;
    }

    function remove(array, name) { return array.filter(n => n !== name); }

    /* What a change of a slot's variant leaves: parameters that the new one has. */
    function useVariant(store, state, slot, variant) {
        const known = variantOf(store, slot, variant)?.parameters.map(p => p.name) || [];
        state.use[slot] = variant;
        for (const name of Object.keys(state.set)) if (name.startsWith(`${slot}.`) && !known.includes(name)) delete state.set[name];
        if (isGone(store, slot, variant)) Object.assign(state, {skip: remove(state.skip, slot), force: remove(state.force, slot)});
        return state;
    }

    function variantOf(store, slot, variant) {
        return store.registry.passes.find(p => p.slot === slot && p.variant === variant);
    }

    /* Some slots have a variant of that name. */
    function isGone(store, slot, variant) { return variant === NONE && !variantOf(store, slot, NONE); }

    function differsIn(state, slot) {
        return slot in state.use || state.skip.includes(slot) || state.force.includes(slot) || Object.keys(state.set).some(n => n.startsWith(`${slot}.`));
    }

    function revertSlot(state, slot) {
        delete state.use[slot];
        for (const name of Object.keys(state.set)) if (name.startsWith(`${slot}.`)) delete state.set[name];
        return Object.assign(state, {skip: remove(state.skip, slot), force: remove(state.force, slot)});
    }

    /* ---- Parameters ---- */

    function parameterAct(store, p, presetOf) {
        return {
            set: (value, drag) => {
                const refused = store.refusal?.names.includes(p.name);
                store.change(state => { if (value === presetOf()) delete state.set[p.name]; else state.set[p.name] = value; }, {drag: drag && `${p.name} ${drag}`});
                if (refused && store.refusal?.names.includes(p.name)) store.clearRefusal();
            },
            settle: () => store.settle(),
            refresh: () => store.emit('slots'),
            revert: () => store.change(state => { delete state.set[p.name]; }),
        };
    }

    function parameterControl(store, p) {
        let preset = p.default;
        const control = glintLive.control(p, parameterAct(store, p, () => preset));
        return {...control, update(said) {
            preset = said ? said.preset : p.default;
            const refused = store.refusal?.names.includes(p.name) ? store.refusal.message : null;
            control.show({value: p.name in store.state.set ? store.state.set[p.name] : preset, preset, refused});
        }};
    }

    /* ---- A slot ---- */

    function slotHead(store, slot, toggle) {
        const info = store.registry.passes.find(p => p.slot === slot);
        const variants = store.registry.passes.filter(p => p.slot === slot);
        const fold = element('button', {type: 'button', class: 'fold', 'aria-expanded': 'false', 'aria-label': `${slot}: parameters`, click: toggle});
        const on = element('input', {type: 'checkbox', 'aria-label': `${slot}: runs`, title: `off: ${SKIPPED} (--skip)`, change: () =>
            store.change(s => { s.skip = on.checked ? remove(s.skip, slot) : [...remove(s.skip, slot), slot]; s.force = remove(s.force, slot); })});
        const variant = element('select', {'aria-label': `${slot}: variant`, change: () => store.change(s => useVariant(store, s, slot, variant.value))},
            ...variants.map(v => element('option', {value: v.variant, title: glintChart.text(`${v.title}, ${v.source}`)}, v.variant)),
            variants.some(v => v.variant === NONE) ? null : element('option', {value: NONE}, NONE));
        const force = element('button', {type: 'button', class: 'force', title: 'run it even if the plan finds that it is not needed (--force)', click: () =>
            store.change(s => { s.force = s.force.includes(slot) ? remove(s.force, slot) : [...s.force, slot]; })}, 'Run anyway');
        const revert = element('button', {type: 'button', class: 'revert', 'aria-label': `${slot}: back to the preset`, title: 'all of this slot back to the preset',
            click: () => { store.change(s => revertSlot(s, slot)); fold.focus(); }}, '\u21ba');
        const time = element('span', {class: 'bar time'}), fetches = element('span', {class: 'bar fetches'}), note = element('p', {class: 'why'});
        const title = element('button', {type: 'button', class: 'title', tabindex: -1, title: glintChart.text(info?.slot_title), click: toggle},
            element('b', null, slot), ' ', element('span', {class: 'faint'}, info?.slot_title));
        const row = element('div', {class: 'head'}, fold, on, title, revert, variant, time, fetches, note, force);
        return {row, fold, on, variant, force, revert, time, fetches, note};
    }

    /* Why a pass did not run, or what it ran with. */
    function noteOf(store, slot, variant, pass, said, counted) {
        const {state} = store;
        if (isGone(store, slot, variant)) return 'not in the pipeline';
        if (state.skip.includes(slot)) return SKIPPED;
        const words = [];
        if (pass && !pass.ran && !pass.cached) words.push(`left out: ${pass.reason || 'nothing needs it'}`);
        if (pass?.cached && counted) words.push(KEPT);
        if (said?.shader) words.push(`shader ${said.shader}${store.error?.message?.includes(said.shader) ? ': does not compile' : ''}`);
        if (state.force.includes(slot)) words.push('forced');
        return words.join(' \u00b7 ');
    }

    function bar(cell, text, share, title) {
        cell.textContent = text;
        cell.title = title;
        cell.style.setProperty('--share', `${(100 * share).toFixed(1)}%`);
        cell.classList.toggle('empty', !text);
    }

    function slotRow(store, slot) {
        const body = element('div', {class: 'parameters', hidden: ''});
        let open = false, found = false, shown = null, controls = [];
        const times = new Map(); /* of each variant, when it was last measured */
        const fold = () => {
            body.hidden = !(open || found);
            head.fold.setAttribute('aria-expanded', String(!body.hidden));
        };
        const head = slotHead(store, slot, () => { open = body.hidden; found = false; fold(); });
        const row = element('li', {class: 'slot', 'data-slot': slot}, head.row, body);

        function build(variant) {
            if (variant === shown) return;
            shown = variant;
            const pass = variantOf(store, slot, variant);
            controls = list(pass?.parameters).map(p => parameterControl(store, p));
            const from = pass ? element('p', {class: 'faint'}, `${pass.title}${pass.source ? ` \u00b7 source: ${pass.source}` : ''}`) : null;
            const none = pass && !controls.length ? element('p', {class: 'faint'}, 'No parameters.') : null;
            body.replaceChildren(...[from, ...controls.map(c => c.row), none].filter(e => e));
        }

        function update(said, scale) {
            const {state, result} = store, variant = state.use[slot] || said?.variant || NONE;
            const pass = list(result?.passes).find(p => p.slot === slot && p.variant === variant), counted = store.fetchesOf?.(slot);
            build(variant);
            for (const c of controls) c.update(said?.variant === variant ? said.parameters.find(p => p.name === c.parameter.name) : null);
            head.variant.value = variant;
            head.on.checked = !isGone(store, slot, variant) && !state.skip.includes(slot);
            head.on.disabled = isGone(store, slot, variant);
            head.revert.hidden = !differsIn(state, slot);
            row.classList.toggle('differs', differsIn(state, slot));
            row.classList.toggle('off', !head.on.checked || !!(pass && !pass.ran && !pass.cached));
            row.classList.toggle('cached', !!pass?.cached);
            head.note.textContent = glintChart.text(noteOf(store, slot, variant, pass, said, Number.isFinite(counted)));
            const forced = state.force.includes(slot);
            head.force.hidden = !forced && (!pass || pass.ran || pass.cached || !head.on.checked);
            head.force.setAttribute('aria-pressed', String(forced));
            if (Number.isFinite(pass?.ns) && !result.draft) times.set(variant, pass.ns);
            /* those of a draft are times of a quarter of the frame */
            const ns = result?.draft ? times.get(variant) : pass?.ns ?? (pass?.cached ? times.get(variant) : undefined), known = Number.isFinite(counted);
            bar(head.time, Number.isFinite(ns) ? `${pass?.quick ? '\u2264 ' : ''}${milliseconds(ns)}` : '', Number.isFinite(ns) ? ns / scale.ns : 0,
                (pass?.cached_work ? 'runs when a cube map changes only, not in every frame' : 'time on the device when it last ran') +
                (pass?.quick ? '; from a program that reads parameters from memory, which is slower than the pass\u2019s own: Measure times that' : ''));
            bar(head.fetches, known ? `${count(counted)} fetches` : pass?.cached ? KEPT : '', known ? counted / scale.fetches : 0,
                known ? 'texture fetches of all rays of a frame' : 'nothing that it depends on has changed, so it was not run again');
            head.fetches.classList.toggle('kept', !known);
        }

        /* Whether it stands in the list: what is looked for, and whether only what differs shall. */
        function filter(words, only) {
            const {state} = store, infos = store.registry.passes.filter(p => p.slot === slot);
            const has = text => words.every(w => text.toLowerCase().includes(w));
            const whole = has(`${slot} ${infos.map(i => `${i.slot_title} ${i.effect} ${i.variant} ${i.title} ${i.source}`).join(' ')}`);
            const own = controls.filter(({parameter: p}) => has(`${p.name} ${p.help} ${p.source} ${p.unit} ${list(p.choices).join(' ')}`));
            const fit = (own.length && words.length ? own : whole ? controls : own).filter(c => !only || c.parameter.name in state.set), some = fit.length;
            for (const c of controls) c.row.hidden = !fit.includes(c);
            found = some > 0 && (only || (words.length > 0 && own.length > 0));
            row.hidden = !(whole || some) || (only && !differsIn(state, slot));
            fold();
            return !row.hidden;
        }
        return {row, update, filter, variant: () => shown};
    }

    /* What there is to read about a slot. */
    function passElement(store, slot) {
        const variant = store.slots.find(s => s.slot === slot)?.variant, pass = variantOf(store, slot, variant) || store.registry.passes.find(p => p.slot === slot);
        const names = images => list(images).map(i => i.name).join(', ') || 'nothing';
        return element('div', {class: 'help'}, element('b', null, slot), element('span', null, `${pass.slot_title}. ${pass.variant}: ${pass.title}`),
            element('span', {class: 'faint'}, `source: ${pass.source} \u00b7 reads ${names(pass.reads)} \u00b7 writes ${names(pass.writes)}`));
    }

    /* ---- Slots that the pipeline lacks ---- */

    function addRow(store, slot, passes, added) {
        const add = p => element('button', {type: 'button', 'aria-label': `add ${slot}: ${p.variant}`, title: glintChart.text(`${p.title}, ${p.source}`),
            click: () => { store.change(s => useVariant(store, s, slot, p.variant)); added(slot); }}, p.variant);
        return element('div', {class: 'add'}, element('span', null, element('b', null, slot), ' ', element('span', {class: 'faint'}, passes[0].slot_title)),
            element('span', {class: 'variants'}, ...passes.map(add)));
    }

    function missing(store, added) {
        const box = element('details', {class: 'missing'}, element('summary', null, 'Add a pass'));
        let shown = '';
        box.update = (words, there) => {
            const groups = store.registry.effects.map(e => ({...e, passes: store.registry.passes.filter(p => p.effect === e.effect && !there.includes(p.slot))}));
            const known = new Set(store.registry.effects.map(e => e.effect));
            const rest = store.registry.passes.filter(p => !known.has(p.effect) && !there.includes(p.slot));
            const all = [...groups, ...[...new Set(rest.map(p => p.effect))].map(e => ({effect: e, title: e, passes: rest.filter(p => p.effect === e)}))];
            const fits = p => words.every(w => `${p.slot} ${p.variant} ${p.slot_title} ${p.title} ${p.source}`.toLowerCase().includes(w));
            const left = all.map(g => ({...g, passes: g.passes.filter(fits)})).filter(g => g.passes.length);
            const key = JSON.stringify(left.map(g => g.passes.map(p => [p.slot, p.variant])));
            if (key === shown) return;
            shown = key;
            box.hidden = !left.length;
            box.replaceChildren(box.firstChild, ...left.map(g => element('section', null, element('h3', {title: glintChart.text(g.about)}, g.title),
                ...[...new Set(g.passes.map(p => p.slot))].map(slot => addRow(store, slot, g.passes.filter(p => p.slot === slot), added)))));
        };
        return box;
    }

    /* ---- The panel ---- */

    /* Slots in order, also those that the state takes out; what is added now gets its place when the server has answered. */
    function orderOf(store) {
        const order = store.slots.map(s => s.slot);
        return [...order, ...Object.keys(store.state.use).filter(s => !order.includes(s))];
    }

    function tools(store, filter) {
        const search = element('input', {type: 'search', id: 'search', placeholder: 'Search passes, parameters, help',
            'aria-label': 'Search passes, parameters and their help', input: filter});
        const only = element('input', {type: 'checkbox', change: filter});
        const all = element('button', {type: 'button', title: 'everything back to the preset', click: () => store.change(s => bare(s.capture, s.preset))}, 'Reset all');
        const head = element('div', {class: 'tools'}, element('h2', null, 'Pipeline'), element('label', null, only, ' only what differs'), all);
        return {bars: [head, element('div', {class: 'tools'}, search)], search, only, all};
    }

    return function (store) {
        const rows = new Map(), slots = element('ol', {class: 'slots'}), whole = element('div', {class: 'parameters whole'});
        const general = list(store.registry.pipeline).map(p => parameterControl(store, p));
        const add = missing(store, slot => { added = slot; }), bars = tools(store, () => filter()), none = element('p', {class: 'faint', hidden: ''}, 'Nothing fits.');
        const help = element('div', {class: 'strip', 'aria-hidden': 'true'});
        let order = [], last = null; /* the last result that is no draft */
        let added = null; /* the slot that gets the focus, which was at a button that goes */
        whole.append(...general.map(c => c.row));

        function filter() {
            const words = bars.search.value.toLowerCase().split(/\s+/).filter(w => w), only = bars.only.checked;
            const left = order.filter(s => rows.get(s).filter(words, only)).length;
            for (const {row, parameter: p} of general)
                row.hidden = !words.every(w => `${p.name} ${p.help}`.toLowerCase().includes(w)) || (only && !(p.name in store.state.set));
            add.update(words, order);
            if (words.length && !only) add.open = !left && !add.hidden;
            add.classList.toggle('unwanted', only);
            none.hidden = left > 0 || general.some(c => !c.row.hidden) || (!add.hidden && !only);
        }

        function update() {
            order = orderOf(store);
            for (const slot of order) if (!rows.has(slot)) rows.set(slot, slotRow(store, slot));
            const wanted = order.map(s => rows.get(s).row);
            if (wanted.length !== slots.children.length || wanted.some((r, i) => slots.children[i] !== r)) {
                const focused = document.activeElement;
                slots.replaceChildren(...wanted);
                if (focused !== document.activeElement && slots.contains(focused)) focused.focus({preventScroll: true}); /* which moving takes away */
            }
            if (added && rows.get(added)?.row.isConnected) {
                rows.get(added).row.querySelector('.fold').focus();
                added = null;
            }
            if (store.result && !store.result.draft) last = store.result;
            const numbers = key => order.map(key).filter(Number.isFinite), passes = list(last?.passes);
            const scale = {ns: Math.max(1, ...numbers(s => passes.find(p => p.slot === s)?.ns)), fetches: Math.max(1, ...numbers(s => store.fetchesOf?.(s)))};
            for (const slot of order) rows.get(slot).update(store.slots.find(s => s.slot === slot), scale);
            for (const c of general) c.update(null);
            const {state} = store, n = Object.keys(state.set).length + Object.keys(state.use).length + state.skip.length + state.force.length;
            bars.all.disabled = n === 0;
            bars.all.textContent = n ? `Reset all (${n})` : 'Reset all';
            filter();
        }

        /* What has the focus is explained in a place of its own, so that nothing moves under the pointer. */
        function explain(event) {
            const name = event.target.closest?.('.parameter')?.dataset.name, slot = event.target.closest?.('.slot')?.dataset.slot;
            const own = variantOf(store, slot, rows.get(slot)?.variant())?.parameters;
            const found = name && [...list(store.registry.pipeline), ...list(own)].find(p => p.name === name);
            if (found) help.replaceChildren(glintLive.control.helpElement(found));
            else if (slot && event.type === 'focusin') help.replaceChildren(passElement(store, slot));
        }

        let due = false;
        const later = () => {
            if (due) return;
            due = true;
            requestAnimationFrame(() => { due = false; update(); });
        };
        for (const name of ['state', 'slots', 'result', 'refused', 'figures', 'error']) store.on(name, later);
        update();
        return element('section', {class: 'panel pipeline', id: 'pipeline', 'aria-label': 'Pipeline', tabindex: -1, focusin: explain, pointerover: explain},
            ...bars.bars, element('div', {class: 'list'}, whole, slots, none, add), help);
    };
})();
