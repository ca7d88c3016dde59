/* The panel of figures: error, end reasons, times and fetches of the state, each with its difference to B, and the points tried so far.
   glintLive.figures(store) is the element. */
glintLive.figures = (function () {
    'use strict';
    const {element, list, numberText} = glintParts, {store: {keyOf}, meter: {effectsOf, hasTruth}} = glintLive;
    const QUIET_MS = 300; /* without a change, before measuring by itself */
    const ROUNDS_MAX = 100;

    function percent(a, b) {
        if (!Number.isFinite(a) || !Number.isFinite(b) || b === 0) return '';
        if (a * b < 0) return glintChart.number(+(a - b).toPrecision(3)).replace(/^(?=\d)/, '+'); /* no part of each other */
        const part = 100 * (a - b) / Math.abs(b);
        return Math.abs(part) < 0.05 ? '0 %' : `${part > 0 ? '+' : '\u2212'}${numberText(Math.abs(part), Math.abs(part) < 100 ? 1 : 0)} %`;
    }

    /* Of shares: the difference in hundredths. */
    function points(a, b) {
        const d = Number.isFinite(a) ? 100 * (a - (Number.isFinite(b) ? b : 0)) : NaN;
        return Number.isFinite(d) ? Math.abs(d) < 0.005 ? '0' : `${d < 0 ? '\u2212' : '+'}${Math.abs(d).toFixed(2)}` : '';
    }

    /* Values, and where there is a B its values and the difference. rows: [[name, a, b, unit, title], …] */
    function comparison(rows, pinned, caption) {
        const words = v => Number.isInteger(v) && v >= 1000 ? numberText(v, 0) : glintChart.number(+v.toPrecision(4));
        const number = v => element('td', {class: 'number'}, Number.isFinite(v) ? words(v) : '\u2013');
        const cells = ([name, a, b, unit, title]) => element('tr', {title: title ? glintChart.text(title) : null}, nameCell(name, unit), number(a),
            ...(pinned ? [number(b), changeCell(percent(a, b))] : []));
        return table(caption, ['A', ...(pinned ? ['B', 'vs. B'] : [])], rows.map(cells));
    }

    function nameCell(name, unit) { return element('th', {scope: 'row'}, name, unit ? element('span', {class: 'unit'}, ` ${unit}`) : null); }

    function changeCell(text, title) { return element('td', {class: 'number change', title}, text); }

    function table(caption, heads, rows) {
        const head = (text, number) => element('th', {scope: 'col', class: number ? 'number' : null}, text);
        return element('div', {class: 'scroll'}, element('table', {class: 'figures'}, caption ? element('caption', null, caption) : null,
            element('thead', null, element('tr', null, head('', false), ...heads.map(h => head(h, true)))), element('tbody', null, ...rows)));
    }

    /* ---- What is shown: the last figures, until there are those of the state ---- */

    const RAYS = [['rays', 'rays', ''], ['steps of a ray', 'steps', ''], ['fetches of a ray', 'fetches', ''], ['steps', 'steps_px', 'a pixel'], ['fetches', 'fetches_px', 'a pixel']];

    function headline(store, meter) {
        const {figures: a, other: b} = meter, pinned = store.pinned && !store.pinned.of ? store.pinned : null;
        const metric = store.registry.metrics.find(m => m.name === meter.metric), rows = [];
        const ms = ns => Number.isFinite(ns) ? ns / 1e6 : null;
        const rounds = meter.isCurrent() && Number.isFinite(a.frame_ns) ? a.rounds : 0;
        if (a?.against) rows.push([metric?.title || meter.metric, meter.total(a)?.value, meter.total(b)?.value, '', metric?.help]);
        rows.push(['time of a frame', ms(meter.timeOf(rounds ? a : null, store.result)), ms(meter.timeOf(rounds ? b : null, rounds ? null : pinned?.result)), /* like with like */
           
            rounds ? `ms, median of ${rounds}` : 'ms, one replay', 'sum of the passes that run in every frame']);
        if (Number.isFinite(a?.cubemaps_ns)) rows.push(['when a cube map changes', ms(a.cubemaps_ns), ms(b?.cubemaps_ns), 'ms']);
        for (const [name, key, unit] of a ? RAYS : []) if (Number.isFinite(a[key])) rows.push([name, a[key], b?.[key], unit]);
        return comparison(rows, pinned, null);
    }

    function errorTables(meter, pinned) {
        const errors = list(meter.figures?.errors).filter(e => e.metric === meter.metric).slice(1); /* the first is in the headline */
        const other = e => list(meter.other?.errors).find(o => o.metric === e.metric && o.set === e.set && o.class === e.class)?.value;
        const rowsOf = set => errors.filter(e => e.set === set).map(e => [e.class, e.value, other(e), '', `${e.pixels} pixels`]);
        return [...new Set(errors.map(e => e.set))].map(set => comparison(rowsOf(set), pinned, set ? `Error by ${set}` : 'Error'));
    }

    function endTable(meter, pinned) {
        const ends = list(meter.figures?.ends), several = new Set(ends.map(e => e.tracer)).size > 1, errors = ends.some(e => Number.isFinite(e.error));
        if (!ends.length) return null;
        const other = e => list(meter.other?.ends).find(o => o.tracer === e.tracer && o.reason === e.reason)?.share;
        const number = text => element('td', {class: 'number'}, text), share = v => Number.isFinite(v) ? `${(100 * v).toFixed(1)} %` : '\u2013';
        const row = e => element('tr', {title: `${numberText(e.rays, 0)} rays`}, nameCell(e.text, several ? `(${e.tracer})` : ''),
            ...(pinned ? [] : [number(numberText(e.rays, 0))]), number(share(e.share)),
            ...(pinned ? [number(share(other(e))), changeCell(meter.other ? points(e.share, other(e)) : '', 'in hundredths of all rays')] : []),
            ...(errors ? [number(Number.isFinite(e.error) ? glintChart.number(+e.error.toPrecision(3)) : '\u2013')] : []));
        return table('Why rays ended', [...(pinned ? [] : ['rays']), 'A', ...(pinned ? ['B', 'vs. B'] : []), ...(errors ? ['error'] : [])], ends.map(row));
    }

    /* The states that were measured like this one. */
    function chartOf(store, meter) {
        const metric = store.registry.metrics.find(m => m.name === meter.metric), b = store.pinned && !store.pinned.of ? keyOf(store.pinned.result.state) : null;
        const fits = meter.tried.filter(t => t.effect === store.effect && t.metric === meter.metric && t.capture === store.state.capture && t.against === meter.figures?.against);
        const now = keyOf(store.state), at = t => ({x: t.time / 1e6, y: t.error});
        const marks = fits.flatMap(t => keyOf(t.state) === now ? [{...at(t), label: 'A'}] : keyOf(t.state) === b ? [{...at(t), label: 'B'}] : []);
        const series = [{name: 'states', kind: 'scatter', points: fits.map(t => ({...at(t), name: t.name}))}];
        return {fits, chart: {title: 'Tried so far', height: 260, x: {name: 'time of a frame', unit: 'ms'}, y: {name: metric?.title || 'error'}, series, marks}};
    }

    function scatter(store, meter) {
        const own = glintLive.page, box = element('div', {class: 'tried'});
        let drawn = null, shown = '', fits = [];
        /* Names leave out what differs beyond the first changes. */
        const choose = p => { const t = fits.find(f => f.name === p.name && f.time / 1e6 === p.x && f.error === p.y); if (t) store.setState({...t.state, capture: store.state.capture}); };
        box.update = () => {
            const next = chartOf(store, meter), key = JSON.stringify(next.chart);
            fits = next.fits;
            if (key === shown) return;
            shown = key;
            box.hidden = !fits.length;
            if (box.hidden) return;
            if (drawn) drawn.replace(next.chart);
            else {
                drawn = glintParts.chartElement(next.chart, own, choose);
                box.replaceChildren(drawn, element('p', {class: 'faint'}, 'A click on a point, or Enter, goes back to its state.'));
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
        const rounds = element('input', {type: 'number', min: 0, max: ROUNDS_MAX, value: meter.rounds, class: 'exact', 'aria-label': 'timed rounds', change: () => {
            meter.rounds = Math.max(0, Math.min(ROUNDS_MAX, Math.round(+rounds.value) || 0));
            rounds.value = meter.rounds;
        }});
        const run = element('button', {type: 'button', id: 'measure', title: 'measures the error, and the times in so many rounds (m)',
            click: () => meter.measure(meter.rounds, true)}, 'Measure');
        const automatic = element('input', {type: 'checkbox', change: () => { meter.automatic = automatic.checked; meter.follow(); }});
        metric.append(...store.registry.metrics.map(m => element('option', {value: m.name, title: glintChart.text(m.help)}, m.title || m.name)));
        let shown = '';
        function update() {
            const effects = effectsOf(store), truth = hasTruth(store), key = JSON.stringify([effects.map(e => e.effect), truth, store.effect]);
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
            run.disabled = !store.effect;
            metric.value = meter.metric;
        }
        return {update, row: element('div', {class: 'tools'}, effect, against, metric, run,
            element('label', {title: 'rounds of the replay that times are measured in'}, rounds, ' rounds'), element('label', null, automatic, ' measure after each change'))};
    }

    return function (store) {
        const own = glintLive.meter(store), bar = choices(store, own), chart = scatter(store, own);
        const body = element('div'), said = element('p', {class: 'faint', role: 'status'});
        store.fetchesOf = slot => own.isCurrent() ? list(own.figures.passes).find(p => p.slot === slot)?.fetches : undefined;
        store.measure = () => own.measure(own.rounds, true);

        function words() {
            if (own.failed()) return own.failed();
            if (own.running) return 'measuring \u2026';
            if (!store.effect) return store.result ? 'Nothing that this pipeline makes can be judged.' : '';
            if (!own.isCurrent()) return own.isAutomatic() ? 'waiting to measure \u2026' : own.figures ? 'These are of an earlier state: measure again.' : 'Not measured yet.';
            const {why, against} = own.figures;
            return [why || (against ? '' : 'There is nothing to compare with.'), store.pinned?.of ? `B, ${store.pinned.title}, has no figures of its own.` : ''].filter(t => t).join(' ');
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
        return element('section', {class: 'panel figures-panel', id: 'figures', 'aria-label': 'Figures', tabindex: -1},
            element('h2', null, 'Figures'), bar.row, said, body, chart);
    };
})();
