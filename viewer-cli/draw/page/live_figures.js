/* The panel of figures: error, end reasons, times and fetches of the state, each with its difference to B, and the points tried so far.
   glintLive.figures(store) is the element. */
glintLive.figures = (function () {
    'use strict';
    const {element, list, numberText} = glintParts, {api, store: {keyOf, copy}} = glintLive;
    const QUIET_MS = 300; /* without a change, before measuring by itself */
    const ROUNDS_MAX = 100;
    const QUICK_S = 1; /* replays up to this long are measured after each change, unless somebody says otherwise */

    function percent(a, b) {
        if (!Number.isFinite(a) || !Number.isFinite(b) || b === 0) return '';
        if (a * b < 0) return glintChart.number(+(a - b).toPrecision(3)).replace(/^(?=\d)/, '+'); /* no part of each other */
        const part = 100 * (a - b) / Math.abs(b);
        return Math.abs(part) < 0.05 ? '0 %' : `${part > 0 ? '+' : '\u2212'}${numberText(Math.abs(part), Math.abs(part) < 100 ? 1 : 0)} %`;
    }

    /* Of shares: the difference in hundredths. */
    function points(a, b) {
        const d = Number.isFinite(a) ? 100 * (a - (Number.isFinite(b) ? b : 0)) : NaN;
        return Number.isFinite(d) ? `${d < 0 ? '\u2212' : '+'}${numberText(Math.abs(d), 1)}` : '';
    }

    /* Names, values, and where there is a B its values and the difference. rows: [[name, a, b, unit, title], …] */
    function comparison(heads, rows, pinned, caption) {
        const number = v => Number.isFinite(v) ? glintChart.number(+v.toPrecision(4)) : '\u2013';
        const cells = ([name, a, b, unit, title]) => element('tr', {title: title ? glintChart.text(title) : null}, element('th', {scope: 'row'}, name, unit ? element('span', {class: 'unit'}, ` ${unit}`) : null),
            element('td', {class: 'number'}, number(a)),
            ...(pinned ? [element('td', {class: 'number'}, number(b)), element('td', {class: 'number change'}, percent(a, b))] : []));
        return element('div', {class: 'scroll'}, element('table', {class: 'figures'}, caption ? element('caption', null, caption) : null,
            element('thead', null, element('tr', null, element('th', {scope: 'col'}, heads), element('th', {scope: 'col', class: 'number'}, 'A'),
                ...(pinned ? [element('th', {scope: 'col', class: 'number'}, 'B'), element('th', {scope: 'col', class: 'number'}, 'vs. B')] : []))),
            element('tbody', null, ...rows.map(cells))));
    }

    /* ---- What is measured ---- */

    function effectsOf(store) {
        const made = new Set(list(store.result?.images).map(i => i.name));
        return store.registry.effects.filter(e => list(e.results).some(r => made.has(r)));
    }

    function meter(store) {
        const cache = new Map(), tried = [];
        const self = {against: 'truth', metric: null, rounds: store.registry.rounds || 0, automatic: null, figures: null, other: null, running: null, error: null, tried};
        const keyFor = (state, against) => JSON.stringify([keyOf(state), store.effect, against, self.metric]);
        const against = () => !self.against || self.against === 'reference' || list(store.registry.captures[store.state.capture]?.truth).includes(store.effect) ? self.against : null;

        /* Times once measured are not lost to a measurement without them. */
        async function measure(state, rounds, wanted) {
            const of = against(), key = keyFor(state, of), known = cache.get(key);
            if (known && (known.rounds >= rounds)) return known;
            const answer = await api.insist('/api/v1/figures', {state, effect: store.effect, against: of, metrics: self.metric ? [self.metric] : [], rounds, client: api.client}, wanted);
            const entry = {...answer, rounds, key, state: copy(state)};
            cache.set(key, entry);
            if (cache.size > 500) cache.delete(cache.keys().next().value);
            return entry;
        }

        /* The error over all pixels, which comes first among the sets of classes. */
        self.total = figures => list(figures?.errors).find(e => e.metric === self.metric && Number.isFinite(e.value)) || null;
        self.timeOf = (figures, result) => Number.isFinite(figures?.frame_ns) ? figures.frame_ns : result && !result.draft ? result.frame_ns : null;

        function note(figures, result) {
            const error = self.total(figures)?.value, time = self.timeOf(figures, keyOf(result?.state || {}) === keyOf(figures.state) ? result : null);
            if (!Number.isFinite(error) || !Number.isFinite(time)) return;
            const at = tried.findIndex(t => t.key === figures.key), point = {key: figures.key, state: figures.state, error, time, effect: store.effect, against: figures.against,
                metric: self.metric, capture: figures.state.capture, name: store.titleOf(figures.state)};
            if (at < 0) tried.push(point); else tried[at] = point;
        }

        self.measure = async (rounds, asked) => {
            const {result} = store;
            if (!result || result.draft || !store.effect || !self.measurable() || (self.running && !asked)) return;
            const state = copy(result.state), mine = self.running = {key: keyFor(state, against())};
            const wanted = () => self.running === mine && keyOf(store.state) === keyOf(state);
            self.error = null;
            store.emit('figures');
            try {
                const found = await measure(state, rounds, wanted);
                if (!wanted()) return;
                self.figures = found;
                note(found, result);
                store.emit('figures');
                self.other = null;
                if (store.pinned && !store.pinned.of) {
                    self.other = await measure(store.pinned.result.state, rounds, wanted);
                    note(self.other, store.pinned.result);
                }
            } catch (error) {
                if (error.code !== 'superseded') self.error = error;
            } finally {
                if (self.running === mine) self.running = null;
                store.emit('figures');
                if (!self.running && keyOf(store.state) !== keyOf(state)) self.follow();
            }
        };
        /* Never against the reference, whose rays take minutes. */
        self.isAutomatic = () => self.against !== 'reference' && (self.automatic === null ? !!store.result && store.result.seconds < QUICK_S : self.automatic);
        /* Figures are of pipelines as the plan runs them. */
        self.measurable = () => !store.state.skip.length && !store.state.force.length;
        self.isCurrent = () => !!self.figures && !!store.result && self.figures.key === keyFor(store.result.state, against());
        /* After a whole frame: what is known already costs nothing, the rest is measured where that was asked for. */
        self.follow = () => {
            const {result} = store;
            if (!result || result.draft || store.busy() || store.playing || !self.measurable()) return;
            const known = cache.get(keyFor(result.state, against()));
            if (known || self.isAutomatic()) self.measure(0, false);
        };
        self.reset = () => { self.figures = self.other = null; self.follow(); store.emit('figures'); };
        return self;
    }

    /* ---- What is shown: the last figures, until there are those of the state ---- */

    function headline(store, meter) {
        const {figures: a, other: b} = meter, pinned = store.pinned && !store.pinned.of ? store.pinned : null;
        const metric = store.registry.metrics.find(m => m.name === meter.metric), rows = [];
        const ms = ns => Number.isFinite(ns) ? ns / 1e6 : null;
        if (a?.against) rows.push([metric?.title || meter.metric, meter.total(a)?.value, meter.total(b)?.value, '', metric?.help]);
        const rounds = meter.isCurrent() && Number.isFinite(a.frame_ns) ? a.rounds : 0;
        rows.push(['every frame', ms(meter.timeOf(rounds ? a : null, store.result)), ms(meter.timeOf(b, pinned?.result)), rounds ? `ms, median of ${rounds}` : 'ms, one replay', 'sum of the passes that run in every frame']);
        if (Number.isFinite(a?.cubemaps_ns)) rows.push(['when a cube map changes', ms(a.cubemaps_ns), ms(b?.cubemaps_ns), 'ms']);
        if (a) {
            for (const [name, key, unit] of [['rays', 'rays', ''], ['steps of a ray', 'steps', ''], ['fetches of a ray', 'fetches', ''], ['steps', 'steps_px', '1/pixel'], ['fetches', 'fetches_px', '1/pixel']])
                if (Number.isFinite(a[key])) rows.push([name, a[key], b?.[key], unit]);
        }
        return comparison('', rows, pinned, null);
    }

    function errorTables(meter, pinned) {
        const errors = list(meter.figures?.errors).filter(e => e.metric === meter.metric).slice(1);
        const other = e => list(meter.other?.errors).find(o => o.metric === e.metric && o.set === e.set && o.class === e.class)?.value;
        const sets = [...new Set(errors.map(e => e.set))];
        return sets.map(set => comparison('', errors.filter(e => e.set === set).map(e => [e.class, e.value, other(e), '', `${e.pixels} pixels`]), pinned, set ? `Error by ${set}` : 'Error'));
    }

    function endTable(meter, pinned) {
        const ends = list(meter.figures?.ends);
        if (!ends.length) return null;
        const other = e => list(meter.other?.ends).find(o => o.tracer === e.tracer && o.reason === e.reason);
        const share = v => Number.isFinite(v) ? `${(100 * v).toFixed(1)} %` : '\u2013', several = new Set(ends.map(e => e.tracer)).size > 1, errors = ends.some(e => Number.isFinite(e.error));
        const head = (text, number = true) => element('th', {scope: 'col', class: number ? 'number' : null}, text);
        return element('div', {class: 'scroll'}, element('table', {class: 'figures'}, element('caption', null, 'Why rays ended'), element('thead', null, element('tr', null, head('', false), ...(pinned ? [] : [head('rays')]), head('A'),
            ...(pinned ? [head('B'), head('vs. B')] : []), ...(errors ? [head('error')] : []))),
        element('tbody', null, ...ends.map(e => element('tr', {title: `${numberText(e.rays, 0)} rays`}, element('th', {scope: 'row'}, e.text, several ? element('span', {class: 'unit'}, ` ${e.tracer}`) : null),
            ...(pinned ? [] : [element('td', {class: 'number'}, numberText(e.rays, 0))]), element('td', {class: 'number'}, share(e.share)),
            ...(pinned ? [element('td', {class: 'number'}, share(other(e)?.share)), element('td', {class: 'number change'}, points(e.share, other(e)?.share))] : []),
            ...(errors ? [element('td', {class: 'number'}, Number.isFinite(e.error) ? glintChart.number(+e.error.toPrecision(3)) : '\u2013')] : []))))));
    }

    function chartOf(store, meter) {
        const metric = store.registry.metrics.find(m => m.name === meter.metric);
        const fits = meter.tried.filter(t => t.effect === store.effect && t.metric === meter.metric && t.capture === store.state.capture && t.against === meter.figures?.against);
        const now = keyOf(store.state), b = store.pinned && !store.pinned.of ? keyOf(store.pinned.result.state) : null;
        const point = t => ({x: t.time / 1e6, y: t.error, name: t.name});
        const marks = [...fits.filter(t => keyOf(t.state) === now).map(t => ({x: t.time / 1e6, y: t.error, label: 'A'})),
            ...fits.filter(t => b && b !== now && keyOf(t.state) === b).map(t => ({x: t.time / 1e6, y: t.error, label: 'B'}))];
        return {fits, chart: {title: 'Tried so far', height: 260, x: {name: 'every frame', unit: 'ms'}, y: {name: metric?.title || 'error'}, series: [{name: 'states', kind: 'scatter', points: fits.map(point)}], marks}};
    }

    function scatter(store, meter) {
        const own = glintLive.page, box = element('div', {class: 'tried'});
        let drawn = null, shown = '', fits = [];
        const choose = p => { const t = fits.find(f => f.name === p.name); if (t) store.setState({...t.state, capture: store.state.capture}); };
        box.update = () => {
            const next = chartOf(store, meter), key = JSON.stringify(next.chart);
            fits = next.fits;
            if (key === shown) return;
            shown = key;
            if (fits.length < 1) return;
            if (drawn) drawn.replace(next.chart);
            else {
                box.replaceChildren(drawn = glintParts.chartElement(next.chart, own, choose), element('p', {class: 'faint'}, 'A click on a point, or Enter, goes back to its state.'));
                drawn.draw();
            }
        };
        return box;
    }

    /* ---- Choices ---- */

    function choices(store, meter) {
        const select = (label, change) => element('select', {'aria-label': label, title: label, change});
        const effect = select('effect that is judged', () => { store.setEffect(effect.value); meter.reset(); });
        const against = select('what the error is measured against', () => { meter.against = against.value || null; meter.reset(); });
        const metric = select('metric', () => { meter.metric = metric.value; meter.reset(); });
        const rounds = element('input', {type: 'number', min: 0, max: ROUNDS_MAX, value: meter.rounds, class: 'exact', 'aria-label': 'timed rounds', change: () => { meter.rounds = Math.max(0, Math.min(ROUNDS_MAX, +rounds.value || 0)); rounds.value = meter.rounds; }});
        const run = element('button', {type: 'button', id: 'measure', title: 'measures the error, and the times in so many rounds (m)', click: () => meter.measure(meter.rounds, true)}, 'Measure');
        const automatic = element('input', {type: 'checkbox', change: () => { meter.automatic = automatic.checked; meter.follow(); }});
        metric.append(...store.registry.metrics.map(m => element('option', {value: m.name, title: glintChart.text(m.help)}, m.title || m.name)));
        let shown = '';
        function update() {
            const effects = effectsOf(store), truth = list(store.registry.captures[store.state.capture]?.truth).includes(store.effect), key = JSON.stringify([effects.map(e => e.effect), truth, store.effect]);
            if (key !== shown) {
                shown = key;
                effect.replaceChildren(...effects.map(e => element('option', {value: e.effect, title: glintChart.text(e.about)}, e.title)));
                effect.value = store.effect;
                against.replaceChildren(element('option', {value: 'truth', disabled: truth ? null : ''}, truth ? 'against truth' : 'no truth in capture'),
                    element('option', {value: 'reference'}, 'against reference'), element('option', {value: ''}, 'without error'));
                against.value = meter.against === 'truth' && !truth ? '' : meter.against || '';
            }
            automatic.checked = meter.isAutomatic();
            automatic.disabled = meter.against === 'reference';
            run.disabled = !store.effect || !meter.measurable();
            metric.value = meter.metric;
        }
        return {update, row: element('div', {class: 'tools'}, effect, against, metric, run, element('label', {title: 'rounds of the replay that times are measured in'}, rounds, ' rounds'),
            element('label', null, automatic, ' measure after each change'))};
    }

    return function (store) {
        const own = meter(store), bar = choices(store, own), chart = scatter(store, own);
        own.metric = store.registry.metric || store.registry.metrics[0]?.name || null;
        const body = element('div'), said = element('p', {class: 'faint', role: 'status'});
        store.fetchesOf = slot => own.isCurrent() ? list(own.figures.passes).find(p => p.slot === slot)?.fetches : undefined;
        store.measure = () => own.measure(own.rounds, true);

        function words() {
            if (own.error) return own.error.message;
            if (own.running) return 'measuring \u2026';
            if (!store.effect) return store.result ? 'Nothing that this pipeline makes can be judged.' : '';
            if (!own.measurable()) return 'Figures are not measured while passes are skipped or forced.';
            if (!own.isCurrent()) return own.isAutomatic() ? 'waiting to measure \u2026' : own.figures ? 'These are of an earlier state: measure again.' : 'Not measured yet.';
            return [own.figures.why, own.figures.against || own.figures.why ? null : 'The capture has nothing to compare with.', store.pinned?.of ? 'B is what the result should be, and has no figures.' : null].filter(t => t).join(' ');
        }

        function update() {
            const pinned = store.pinned && !store.pinned.of ? store.pinned : null;
            bar.update();
            said.textContent = glintChart.text(words());
            body.classList.toggle('stale', !!own.figures && !own.isCurrent());
            if (store.result) body.replaceChildren(headline(store, own), ...errorTables(own, pinned), ...[endTable(own, pinned)].filter(t => t));
            chart.update();
        }

        store.on('result', () => {
            const effects = effectsOf(store);
            if (!effects.some(e => e.effect === store.effect)) store.setEffect(effects[0]?.effect || null);
            update();
        });
        let quiet = 0;
        store.on('idle', () => { clearTimeout(quiet); quiet = setTimeout(own.follow, QUIET_MS); });
        store.on('changed', () => clearTimeout(quiet));
        store.on('pinned', () => { own.other = null; update(); if (store.pinned && !store.pinned.of && own.figures) own.follow(); });
        for (const name of ['figures', 'effect', 'state']) store.on(name, update);
        return element('section', {class: 'panel figures-panel', id: 'figures', 'aria-label': 'Figures', tabindex: -1}, element('h2', null, 'Figures'), bar.row, said, body, chart);
    };
})();
