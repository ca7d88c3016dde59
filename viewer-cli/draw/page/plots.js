/* Charts and players of glintParts: a point that is chosen in one chart of a page is chosen in the others, and players go to its frame. */
(function () {
    'use strict';
    const {list, element, terms, figures, tableElement} = glintParts;

    /* ---- Charts ---- */

    /* Every point of a CHART, with what the page says of it. */
    function describe(chart) {
        const read = glintChart.read(chart);
        const points = read.series.flatMap((s, series) => s.points.map((p, i) => ({series, i, p, s})));
        return {
            chart, read, points, places: glintChart.places(chart),
            detailed: points.some(({p}) => list(p.values).length || list(p.pictures).length),
            order: points.map((_, k) => k).sort((a, b) => points[a].p.x - points[b].p.x || points[a].p.y - points[b].p.y),
            keys: read.y.scale === 'category' ? ['y', 'x'] : ['x', 'y'], /* what a point is of comes first */
        };
    }

    function coordinate(read, key, p) {
        const axis = read[key];
        if (axis.scale === 'category') return [axis.name || 'category', list(axis.categories)[p[key]]];
        const low = key === 'x' ? p.x_low : p.low, high = key === 'x' ? p.x_high : p.high;
        return [axis.name || key, {value: p[key], low, high}, axis.unit];
    }

    function coordinates({read, keys}, p) { return terms(keys.map(key => coordinate(read, key, p)), null); }

    /* What stands beside a chart; the point that was kept before is what this one is compared with. */
    function pointElements(data, shown, before, own) {
        if (!shown) return [element('p', {class: 'faint'}, 'Point at a mark to see its parameters and its picture; a click keeps it, Escape lets go, arrow keys go to the next. What differs from the one kept before is marked, and its pictures follow when this one\'s are enlarged.')];
        const {p, s} = shown;
        return [element('h4', null, p.name || s.name), coordinates(data, p),
            element('div', {class: list(p.pictures).length > 1 ? 'shots several' : 'shots'}, ...figures(p.pictures, own, list(before?.pictures))),
            terms(list(p.values), before && list(before.values))];
    }

    /* ECharts' option, with a ring for the chosen point. */
    function chartOption(data, width, tip) {
        const look = glintChart[document.documentElement.dataset.look];
        const option = glintChart.option(data.chart, look, false, width);
        option.tooltip = {
            trigger: 'item', confine: true, backgroundColor: look.ground, borderColor: look.line,
            textStyle: {color: look.text, fontSize: 12}, formatter: tip,
        };
        option.series.push({id: 'chosen', type: 'scatter', silent: true, symbolSize: 18, z: 9, data: [], animation: false,
            itemStyle: {color: 'transparent', borderColor: look.text, borderWidth: 2}});
        return option;
    }

    /* What stays in its place keeps the focus. */
    function attach(e, wanted, insert) {
        if (!wanted) e.remove();
        else if (!e.parentNode) insert(e);
    }

    function leftOut(count) {
        return `${count} point${count > 1 ? 's' : ''} without a place on these axes (not known, or at or below zero of a logarithmic axis) ${count > 1 ? 'are' : 'is'} not drawn.`;
    }

    /* `choose(point)`: called when somebody chooses a POINT by a click or by Enter. The element has draw(), for when it is in the document
       or its width changed, and replace(chart), which keeps the focus and the point of the same name. */
    function chartElement(chart, own, choose) {
        const state = {data: describe(chart), drawn: null, table: null, kept: -1, before: -1, at: -1};
        const plot = element('div', {class: 'plot', tabindex: 0, role: 'group'});
        const aside = element('aside', {class: 'point', 'aria-live': 'polite', tabindex: 0});
        const title = element('h3'), columns = element('div', null, plot), left = element('p', {class: 'faint'});
        const summary = element('summary'), fold = element('details', null, summary), result = element('section', null, columns);

        function show(k) {
            const {data, kept, before} = state, {points} = data;
            state.at = k;
            if (data.detailed) aside.replaceChildren(...pointElements(data, points[k], points[kept === k ? before : kept]?.p, own));
        }

        /* A ring around a mark; bars may stand on others and are highlighted themselves. */
        function ring() {
            const shown = state.data.points[state.at], bar = shown?.s.kind === 'bar';
            state.drawn?.setOption({series: [{id: 'chosen', data: shown && !bar ? [[shown.p.x, shown.p.y]] : []}]});
            state.drawn?.dispatchAction({type: 'downplay'});
            if (bar) state.drawn?.dispatchAction({type: 'highlight', seriesIndex: state.data.places[shown.series], dataIndex: shown.i});
        }

        function go(k) { show(k); ring(); }

        function keep(k) {
            state.table?.lineOf(state.kept)?.classList.remove('chosen');
            if (k !== state.kept) state.before = k < 0 ? -1 : state.kept;
            state.kept = k;
            state.table?.lineOf(k)?.classList.add('chosen');
            go(k);
        }

        /* The point of this name is kept in the other charts too. */
        function select(k) {
            keep(k);
            const point = state.data.points[k]?.p, name = point?.name;
            for (const c of own.charts) if (c.keep !== keep && (name || k < 0)) c.keep(k < 0 ? -1 : c.placeOf(name));
            for (const p of own.players) if (name) p.go(name);
            if (point && choose) choose(point);
        }

        const placeOf = name => state.data.points.findIndex(q => q.p.name === name);
        const placeAt = (series, d) => state.data.points.findIndex(q => state.data.places[q.series] === series && q.i === d?.point);

        function tip(e) {
            const q = state.data.points[placeAt(e.seriesIndex, e.data)];
            return q ? element('div', null, element('b', null, q.p.name || q.s.name), coordinates(state.data, q.p)) : null;
        }

        function attempt(draw) {
            try {
                draw();
            } catch (error) {
                plot.replaceChildren(element('p', {class: 'note'}, `this chart cannot be drawn: ${error.message}`));
            }
        }

        function draw() {
            if (state.drawn) state.drawn.dispose();
            state.drawn = echarts.init(plot, null, {renderer: 'svg'});
            state.drawn.setOption(chartOption(state.data, plot.clientWidth, tip));
            state.drawn.on('mouseover', e => { const k = placeAt(e.seriesIndex, e.data); if (k >= 0) go(k); });
            state.drawn.on('mouseout', () => go(state.kept));
            state.drawn.on('click', e => { const k = placeAt(e.seriesIndex, e.data); if (k >= 0) select(k); });
            ring();
        }

        /* Everything around the plot. */
        function build() {
            const {data} = state, {points, read} = data;
            plot.setAttribute('aria-label', `chart: ${glintChart.text(data.chart.title)}; arrow keys go through its points, Enter keeps one`);
            plot.style.height = aside.style.height = `${glintChart.size(data.chart)[1]}px`;
            title.textContent = glintChart.text(data.chart.title);
            columns.className = data.detailed ? 'chart detailed' : 'chart';
            left.textContent = leftOut(read.left);
            state.table = points.length ? pointTable(data, select) : null;
            summary.textContent = `Its ${points.length} points as a table`;
            fold.replaceChildren(summary, ...(state.table ? [state.table] : []));
            attach(title, data.chart.title, e => result.prepend(e));
            attach(aside, data.detailed, e => columns.append(e));
            attach(left, read.left, e => columns.after(e));
            attach(fold, state.table, e => result.append(e));
        }

        result.draw = () => attempt(draw);
        result.replace = chart => {
            const {kept, before, at, table, data: {points}} = state, line = points.findIndex((_, k) => table.lineOf(k) === document.activeElement);
            const names = [kept, before, at, line].map(k => points[k]?.p.name);
            state.data = describe(chart);
            const places = names.map(name => name === undefined ? -1 : placeOf(name));
            [state.kept, state.before, state.at] = places;
            build();
            state.table?.lineOf(places[3])?.focus();
            state.table?.lineOf(state.kept)?.classList.add('chosen');
            show(state.at < 0 ? state.kept : state.at);
            attempt(() => {
                state.drawn?.resize();
                state.drawn?.setOption(chartOption(state.data, plot.clientWidth, tip), true);
                ring();
            });
        };
        plot.addEventListener('keydown', e => {
            const step = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1}[e.key], {order} = state.data;
            if (step && order.length) {
                const at = order.indexOf(state.at);
                go(order[at < 0 ? (step > 0 ? 0 : order.length - 1) : (at + step + order.length) % order.length]);
            } else if (e.key === 'Enter' && state.at >= 0) select(state.at);
            else if (e.key === 'Escape') select(-1);
            else return;
            e.preventDefault();
        });
        build();
        show(-1);
        own.charts.push({keep, placeOf, draw: result.draw});
        return result;
    }

    function pointTable({read, points, keys}, select) {
        const names = [];
        for (const {p} of points) for (const [name, , unit] of list(p.values)) if (!names.some(n => n.name === name)) names.push({name, unit});
        const several = read.series.length > 1, named = points.some(({p}) => p.name);
        const columns = [...(several ? [{name: 'series'}] : []), ...(named ? [{name: 'point'}] : []),
            ...keys.map(key => ({name: coordinate(read, key, points[0].p)[0], unit: read[key].unit})), ...names];
        const rows = points.map(({p, s}) => [...(several ? [s.name] : []), ...(named ? [p.name] : []),
            ...keys.map(key => coordinate(read, key, p)[1]),
            ...names.map(n => (list(p.values).find(v => v[0] === n.name) || [])[1])]);
        return tableElement({columns, rows}, select);
    }

    function playerElement(player, own) {
        const tracks = list(player.tracks).filter(t => t && list(t.pictures).every(own.sourceOf)), frames = list(player.frames).map(glintChart.text);
        const marks = list(player.marks).filter(m => m && frames[m.frame] !== undefined);
        const state = {frame: 0, track: 0, timer: 0}, name = glintChart.text(player.title);
        if (!tracks.length || !frames.length) return null;
        const image = element('img'), caption = element('figcaption', {'aria-live': 'polite'}), key = element('div');
        const play = element('button', {type: 'button', click: () => state.timer ? stop() : start()});
        const slider = element('input', {type: 'range', min: 0, max: frames.length - 1, step: 1, 'aria-label': `${name}: frame`, input: () => seek(+slider.value)});
        const rate = element('select', {'aria-label': 'frames a second', change: () => { if (state.timer) { stop(); start(); } }},
            ...[2, 5, 10, 25].map(r => element('option', {value: r}, `${r} frames/s`)));
        const choices = tracks.map((t, i) => element('button', {type: 'button', click: () => { state.track = i; show(); }}, t.name));
        const ticks = marks.map(m => {
            const tick = element('i', {title: glintChart.text(m.label)});
            tick.style.left = `${100 * (frames.length > 1 ? m.frame / (frames.length - 1) : 0)}%`;
            return tick;
        });
        rate.value = 10;

        function show() {
            const picture = list(tracks[state.track].pictures)[state.frame];
            const worst = marks.filter(m => m.frame === state.frame).map(m => glintChart.text(m.label));
            if (picture) image.src = own.sourceOf(picture);
            image.alt = glintChart.text(picture?.caption);
            caption.textContent = [`${image.alt} (${state.frame + 1} of ${frames.length})`, ...worst].join(', ');
            caption.className = worst.length ? 'worst' : '';
            slider.value = state.frame;
            key.replaceChildren(...(tracks[state.track].key ? [glintStage.key([tracks[state.track].key])] : []));
            choices.forEach((b, i) => b.setAttribute('aria-pressed', String(i === state.track)));
            play.textContent = state.timer ? 'Pause' : 'Play';
        }

        /* The charts go along, but not ten times a second. */
        function seek(frame) {
            stop();
            state.frame = Math.min(frames.length - 1, Math.max(0, frame));
            show();
            for (const c of own.charts) { const k = c.placeOf(frames[state.frame]); if (k >= 0) c.keep(k); }
        }

        function start() {
            state.timer = setInterval(() => { state.frame = (state.frame + 1) % frames.length; show(); }, 1000 / rate.value);
            show();
        }

        function stop() {
            clearInterval(state.timer);
            state.timer = 0;
            show();
        }

        const shown = element('figure', {tabindex: 0, role: 'group', 'aria-label': `${name}: arrow keys step, Space plays`,
            keydown: e => {
                const step = {ArrowRight: 1, ArrowLeft: -1}[e.key];
                if (step) seek(state.frame + step);
                else if (e.key === ' ') play.click();
                else return;
                e.preventDefault();
            }}, image, key, caption);
        own.players.push({go: frame => { const k = frames.indexOf(glintChart.text(frame)); if (k >= 0 && k !== state.frame) { stop(); state.frame = k; show(); } }});
        show();
        return element('section', {class: 'player'},
            element('div', {class: 'bar', role: 'toolbar', 'aria-label': name}, play, rate, ...choices,
                ...marks.map(m => element('button', {type: 'button', click: () => seek(m.frame)}, `${glintChart.text(m.label)}: ${frames[m.frame]}`))),
            element('div', {class: 'track'}, slider, ...ticks), shown);
    }

    Object.assign(glintParts, {chartElement, playerElement});
})();
