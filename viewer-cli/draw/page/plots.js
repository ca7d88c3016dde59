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

    /* ---- One chart: `at` is the place of the point that is shown, `kept` of the one that was chosen, `before` of the one before that ---- */

    const placeOf = ({data}, name) => data.points.findIndex(q => q.p.name === name);

    /* The place of what ECharts draws, by the number of its series and its datum. */
    const placeAt = ({data}, {seriesIndex, data: datum}) => data.points.findIndex(q => data.places[q.series] === seriesIndex && q.i === datum?.point);

    function show(self, k) {
        const {data: {points, detailed}, kept, before} = self;
        self.at = k;
        if (detailed) self.aside.replaceChildren(...pointElements(self.data, points[k], points[kept === k ? before : kept]?.p, self.own));
    }

    /* A ring around a mark; bars may stand on others and are highlighted themselves. */
    function ring({data, at, drawn}) {
        const shown = data.points[at], bar = shown?.s.kind === 'bar';
        drawn?.setOption({series: [{id: 'chosen', data: shown && !bar ? [[shown.p.x, shown.p.y]] : []}]});
        drawn?.dispatchAction({type: 'downplay'});
        if (bar) drawn?.dispatchAction({type: 'highlight', seriesIndex: data.places[shown.series], dataIndex: shown.i});
    }

    function go(self, k) {
        show(self, k);
        ring(self);
    }

    function keep(self, k) {
        self.table?.lineOf(self.kept)?.classList.remove('chosen');
        if (k !== self.kept) self.before = k < 0 ? -1 : self.kept;
        self.kept = k;
        self.table?.lineOf(k)?.classList.add('chosen');
        go(self, k);
    }

    /* The point of this name is kept in the other charts too. */
    function select(self, k) {
        const {own, choose} = self, point = self.data.points[k]?.p, name = point?.name;
        keep(self, k);
        for (const c of own.charts) if (c !== self.entry && (name || k < 0)) c.keep(k < 0 ? -1 : c.placeOf(name));
        for (const p of own.players) if (name) p.go(name);
        if (point && choose) choose(point);
    }

    function option(self) {
        return chartOption(self.data, self.plot.clientWidth, e => {
            const q = self.data.points[placeAt(self, e)];
            return q ? element('div', null, element('b', null, q.p.name || q.s.name), coordinates(self.data, q.p)) : null;
        });
    }

    function attempt(self, draw) {
        try {
            draw();
        } catch (error) {
            self.plot.replaceChildren(element('p', {class: 'note'}, `this chart cannot be drawn: ${error.message}`));
        }
    }

    function draw(self) {
        if (self.drawn) self.drawn.dispose();
        self.drawn = echarts.init(self.plot, null, {renderer: 'svg'});
        self.drawn.setOption(option(self));
        self.drawn.on('mouseover', e => { const k = placeAt(self, e); if (k >= 0) go(self, k); });
        self.drawn.on('mouseout', () => go(self, self.kept));
        self.drawn.on('click', e => { const k = placeAt(self, e); if (k >= 0) select(self, k); });
        ring(self);
    }

    /* Everything around the plot. */
    function build(self) {
        const {data: {chart, points, read, detailed}, plot, aside, title, columns, left, summary, fold, result} = self;
        plot.setAttribute('aria-label', `chart: ${glintChart.text(chart.title)}; arrow keys go through its points, Enter keeps one`);
        plot.style.height = aside.style.height = `${glintChart.size(chart)[1]}px`;
        title.textContent = glintChart.text(chart.title);
        columns.className = detailed ? 'chart detailed' : 'chart';
        left.textContent = leftOut(read.left);
        self.table = points.length ? pointTable(self.data, k => select(self, k)) : null;
        summary.textContent = points.length === 1 ? 'Its point as a table' : `Its ${points.length} points as a table`;
        fold.replaceChildren(summary, ...(self.table ? [self.table] : []));
        attach(title, chart.title, e => result.prepend(e));
        attach(aside, detailed, e => columns.append(e));
        attach(left, read.left, e => columns.after(e));
        attach(fold, self.table, e => result.append(e));
    }

    function replace(self, chart) {
        const {data: {points}, table} = self, line = points.findIndex((_, k) => table.lineOf(k) === document.activeElement);
        const names = [self.kept, self.before, self.at, line].map(k => points[k]?.p.name);
        self.data = describe(chart);
        const places = names.map(name => name === undefined ? -1 : placeOf(self, name));
        [self.kept, self.before, self.at] = places;
        build(self);
        self.table?.lineOf(places[3])?.focus();
        self.table?.lineOf(self.kept)?.classList.add('chosen');
        show(self, self.at < 0 ? self.kept : self.at);
        attempt(self, () => {
            self.drawn?.resize();
            self.drawn?.setOption(option(self), true);
            ring(self);
        });
    }

    /* Whether the key means something here. */
    function press(self, key) {
        const step = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1}[key], {order} = self.data;
        if (step && order.length) {
            const at = order.indexOf(self.at);
            go(self, order[at < 0 ? (step > 0 ? 0 : order.length - 1) : (at + step + order.length) % order.length]);
        } else if (key === 'Enter' && self.at >= 0) select(self, self.at);
        else if (key === 'Escape') select(self, -1);
        else return false;
        return true;
    }

    /* `choose(point)`: called when somebody chooses a POINT by a click or by Enter. The element has draw(), for when it is in the document
       or its width changed, and replace(chart), which keeps the focus and the point of the same name. */
    function chartElement(chart, own, choose) {
        const self = {own, choose, data: describe(chart), drawn: null, table: null, kept: -1, before: -1, at: -1};
        self.plot = element('div', {class: 'plot', tabindex: 0, role: 'group', keydown: e => { if (press(self, e.key)) e.preventDefault(); }});
        self.aside = element('aside', {class: 'point', 'aria-live': 'polite', tabindex: 0});
        self.columns = element('div', null, self.plot);
        Object.assign(self, {title: element('h3'), left: element('p', {class: 'faint'}), summary: element('summary')});
        self.fold = element('details', null, self.summary);
        self.result = element('section', null, self.columns);
        build(self);
        show(self, -1);
        self.entry = {keep: k => keep(self, k), placeOf: name => placeOf(self, name), draw: () => attempt(self, () => draw(self))};
        own.charts.push(self.entry);
        return Object.assign(self.result, {draw: self.entry.draw, replace: chart => replace(self, chart)});
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
