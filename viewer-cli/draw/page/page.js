/* Builds a page of page.h from its document. Texts become text nodes, never markup. */
(function () {
    'use strict';
    const page = JSON.parse(document.getElementById('document').textContent);
    const data = /^data:image\/(png|jpeg);base64,[A-Za-z0-9+\/=]*$/;
    const charts = [], players = [];
    let folds = 0;
    const WORDS = ['infinite', 'minus infinite', 'not a number']; /* in columns of numbers */

    function list(v) { return Array.isArray(v) ? v : []; }

    /* element('td', {class: 'number'}, child or text, …) */
    function element(name, attributes, ...children) {
        const e = document.createElement(name);
        for (const [key, value] of Object.entries(attributes || {}))
            if (typeof value === 'function') e.addEventListener(key, value);
            else if (value !== undefined && value !== null) e.setAttribute(key, value);
        for (const c of children)
            if (c !== null && c !== undefined) e.append(c instanceof Node ? c : glintChart.text(c));
        return e;
    }

    /* ---- Cells ---- */

    function valueOf(cell) {
        if (cell !== null && typeof cell === 'object') return valueOf(cell.value !== undefined ? cell.value : cell.text);
        return cell === undefined ? null : cell;
    }

    /* Decimals at which a column's largest number has four digits, so that points stand below each other; fewer when
       none of them needs as many. */
    function decimalsOf(numbers) {
        const largest = Math.max(0, ...numbers.map(Math.abs));
        if (largest === 0) return 0;
        const needed = Math.max(...numbers.map(v => {
            const text = String(+v.toPrecision(7));
            return text.includes('e-') ? 6 : (text.split('.')[1] || '').length;
        }));
        return Math.min(6, needed, Math.max(0, 3 - Math.floor(Math.log10(largest))));
    }

    function numberText(v, decimals) {
        if (!Number.isFinite(v)) return '\u2013';
        if (decimals === undefined || decimals === null) return glintChart.number(v);
        const size = Math.abs(v);
        if (size !== 0 && size < 10 ** (1 - decimals) && !Number.isInteger(v) || size >= 1e9) return glintChart.number(+v.toPrecision(2));
        return v.toFixed(decimals).replace('-', '\u2212').replace(/\B(?=(\d{3})+(?!\d))/g, decimals ? '' : '\u202f');
    }

    function cellText(cell, decimals) {
        if (cell !== null && typeof cell === 'object' && cell.text !== undefined) return cell.text;
        const v = valueOf(cell);
        return v === null ? '\u2013' : typeof v === 'number' ? numberText(v, decimals) : typeof v === 'boolean' ? (v ? 'yes' : 'no') : v;
    }

    function intervalText(cell, decimals) {
        if (cell === null || typeof cell !== 'object' || !Number.isFinite(cell.low) || !Number.isFinite(cell.high) || cell.low === cell.high) return '';
        return `${numberText(cell.low, decimals)} to ${numberText(cell.high, decimals)}`;
    }

    /* ---- Tables ---- */

    /* Numbers first, then texts; what is not known last, whichever way. */
    function compare(a, b, sign) {
        const x = valueOf(a), y = valueOf(b);
        if (x === null || y === null) return (x === null) - (y === null);
        if (typeof x !== typeof y) return typeof x === 'number' ? -1 : 1;
        return sign * (typeof x === 'string' ? x.localeCompare(y, undefined, {numeric: true}) : x - y);
    }

    function columnOf(column, cells) {
        const numbers = cells.map(valueOf).filter(v => typeof v === 'number' && Number.isFinite(v));
        const known = cells.filter(c => valueOf(c) !== null);
        const number = numbers.length > 0 && known.every(c => Number.isFinite(valueOf(c)) || WORDS.includes(valueOf(c)));
        return {
            ...column, number, largest: Math.max(0, ...numbers), intervals: cells.some(c => intervalText(c)),
            decimals: Number.isInteger(column.decimals) ? column.decimals : number ? decimalsOf(numbers) : null,
        };
    }

    /* Intervals stand in a place of their own, so that numbers stand below each other. */
    function cellElements(cell, column) {
        const td = element('td', {class: column.number ? 'number' : null}, cellText(cell, column.decimals));
        const v = valueOf(cell);
        if (column.bar && column.number && v > 0) {
            td.classList.add('bar');
            td.style.setProperty('--share', `${(100 * v / column.full).toFixed(1)}%`);
        }
        return column.intervals ? [td, element('td', {class: 'interval'}, intervalText(cell, column.decimals))] : [td];
    }

    /* choose(row's place): what a click on a row does, or nothing. */
    function tableElement(table, choose) {
        const rows = list(table.rows).map(list);
        const columns = list(table.columns).map((c, i) => columnOf(c, rows.map(r => r[i])));
        /* bars of one unit have one scale */
        for (const c of columns) c.full = Math.max(...columns.filter(o => o.bar && o.number && o.unit === c.unit).map(o => o.largest));
        const lines = rows.map((row, i) => {
            const tr = element('tr', choose ? {class: 'choice', tabindex: 0} : null, ...columns.flatMap((c, k) => cellElements(row[k], c)));
            if (choose) {
                tr.addEventListener('click', () => choose(i));
                tr.addEventListener('keydown', e => { if (e.key === 'Enter' || e.key === ' ') { e.preventDefault(); choose(i); } });
            }
            return {tr, row, i};
        });
        const body = element('tbody', null, ...lines.map(l => l.tr));
        const heads = columns.map((c, k) => {
            const button = element('button', {type: 'button', title: c.help ? glintChart.text(c.help) : null}, c.name);
            const th = element('th', {scope: 'col', colspan: c.intervals ? 2 : null, class: c.number && !c.intervals ? 'number' : null}, button, c.unit ? element('span', {class: 'unit'}, c.unit) : null);
            button.addEventListener('click', () => {
                const way = th.getAttribute('aria-sort') === 'ascending' ? 'descending' : 'ascending';
                heads.forEach(h => h.removeAttribute('aria-sort'));
                th.setAttribute('aria-sort', way);
                lines.sort((a, b) => compare(a.row[k], b.row[k], way === 'ascending' ? 1 : -1) || a.i - b.i);
                body.append(...lines.map(l => l.tr));
            });
            return th;
        });
        const result = element('div', {class: 'scroll'}, element('table', null, element('thead', null, element('tr', null, ...heads)), body));
        result.lineOf = i => lines.find(l => l.i === i)?.tr;
        return result;
    }

    /* ---- Pictures ---- */

    function sourceOf(picture) {
        const uri = list(page.files)[picture.file];
        return typeof uri === 'string' && data.test(uri) ? uri : null;
    }

    /* Enlarged; arrows flip to the others in place, so that differences jump out. */
    const view = {dialog: element('dialog'), image: element('img'), caption: element('p', {'aria-live': 'polite'}), all: [], at: 0};
    view.dialog.append(view.image, view.caption);
    view.dialog.addEventListener('click', () => view.dialog.close());
    view.dialog.addEventListener('keydown', e => {
        const step = {ArrowRight: 1, ArrowDown: 1, ' ': 1, ArrowLeft: -1, ArrowUp: -1}[e.key];
        if (!step || !view.all.length) return;
        e.preventDefault();
        enlarge(view.all, (view.at + step + view.all.length) % view.all.length);
    });

    function enlarge(pictures, at) {
        Object.assign(view, {all: pictures, at});
        view.image.src = sourceOf(pictures[at]);
        view.image.alt = glintChart.text(pictures[at].caption);
        view.caption.textContent = glintChart.text(pictures[at].caption) +
            (pictures.length > 1 ? `  (${at + 1} of ${pictures.length}, arrow keys flip)` : '');
        if (!view.dialog.open) view.dialog.showModal();
    }

    /* `more`: what flipping through the enlarged ones comes to after them. */
    function figures(pictures, more) {
        const known = list(pictures).filter(sourceOf), all = [...known, ...list(more).filter(sourceOf)];
        return known.map((p, i) => element('figure', null,
            element('button', {type: 'button', click: () => enlarge(all, i), 'aria-label': `enlarge ${glintChart.text(p.caption)}`},
                element('img', {src: sourceOf(p), alt: glintChart.text(p.caption), loading: 'lazy'})),
            element('figcaption', null, p.caption)));
    }

    function picturesElement(block) {
        const known = list(block.pictures).filter(sourceOf);
        const e = element('div', {class: block.columns === 1 ? 'pictures alone' : 'pictures'}, ...figures(known).flatMap((figure, i) =>
            known[i].group && known[i].group !== known[i - 1]?.group ? [element('h3', null, known[i].group), figure] : [figure]));
        const least = block.columns > 0 ? `max(${Math.floor(96 / block.columns) - 2}%, 200px)` : '360px';
        e.style.gridTemplateColumns = `repeat(auto-fill, minmax(min(${least}, 100%), 1fr))`;
        return e;
    }

    /* ---- Charts ---- */

    function terms(entries, other) {
        return element('dl', null, ...entries.flatMap(([name, cell, unit], i) => {
            const differs = other && other[i] && other[i][0] === name && valueOf(other[i][1]) !== valueOf(cell);
            return [element('dt', null, name), element('dd', {class: differs ? 'differs' : null}, cellText(cell), unit ? ` ${unit}` : '',
                intervalText(cell) ? element('div', {class: 'faint'}, intervalText(cell)) : null)];
        }));
    }

    function chartElement(chart) {
        const read = glintChart.read(chart), places = glintChart.places(chart);
        /* every point, with what the page says of it */
        const points = read.series.flatMap((s, series) => s.points.map((p, i) => ({series, i, p, s})));
        const detailed = points.some(({p}) => list(p.values).length || list(p.pictures).length);
        const plot = element('div', {class: 'plot', tabindex: 0, role: 'group',
            'aria-label': `chart: ${glintChart.text(chart.title)}; arrow keys go through its points, Enter keeps one`});
        const aside = element('aside', {class: 'point', 'aria-live': 'polite', tabindex: 0});
        plot.style.height = aside.style.height = `${glintChart.size(chart)[1]}px`;
        const order = points.map((_, k) => k).sort((a, b) => points[a].p.x - points[b].p.x || points[a].p.y - points[b].p.y);
        const state = {drawn: null, kept: -1, before: -1, at: -1};

        /* what a point is of comes first */
        const keys = read.y.scale === 'category' ? ['y', 'x'] : ['x', 'y'];

        function coordinate(key, p) {
            const axis = read[key];
            if (axis.scale === 'category') return [axis.name || 'category', list(axis.categories)[p[key]]];
            const low = key === 'x' ? p.x_low : p.low, high = key === 'x' ? p.x_high : p.high;
            return [axis.name || key, {value: p[key], low, high}, axis.unit];
        }

        function show(k) {
            state.at = k;
            if (!detailed) return;
            if (k < 0) {
                aside.replaceChildren(element('p', {class: 'faint'}, 'Point at a mark to see its parameters and its picture; a click keeps it, Escape lets go, arrow keys go to the next. What differs from the one kept before is marked, and its pictures follow when this one\'s are enlarged.'));
                return;
            }
            /* the point that was kept before is what this one is compared with */
            const {p, s} = points[k], before = points[state.kept === k ? state.before : state.kept]?.p;
            aside.replaceChildren(element('h4', null, p.name || s.name),
                terms(keys.map(key => coordinate(key, p)), null),
                element('div', {class: list(p.pictures).length > 1 ? 'shots several' : 'shots'}, ...figures(p.pictures, list(before?.pictures))),
                terms(list(p.values), before && list(before.values)));
        }

        /* A ring around a mark; bars may stand on others and are highlighted themselves. */
        function ring() {
            const shown = points[state.at], bar = shown?.s.kind === 'bar';
            state.drawn?.setOption({series: [{id: 'chosen', data: shown && !bar ? [[shown.p.x, shown.p.y]] : []}]});
            state.drawn?.dispatchAction({type: 'downplay'});
            if (bar) state.drawn?.dispatchAction({type: 'highlight', seriesIndex: places[shown.series], dataIndex: shown.i});
        }

        function go(k) { show(k); ring(); }

        function keep(k) {
            if (table && state.kept >= 0) table.lineOf(state.kept).classList.remove('chosen');
            if (k !== state.kept) state.before = k < 0 ? -1 : state.kept;
            state.kept = k;
            if (table && k >= 0) table.lineOf(k).classList.add('chosen');
            go(k);
        }

        /* The point of this name is kept in the other charts too. */
        function choose(k) {
            keep(k);
            const name = points[k]?.p.name;
            for (const c of charts) if (c.keep !== keep && (name || k < 0)) c.keep(k < 0 ? -1 : c.placeOf(name));
            for (const p of players) if (name) p.go(name);
        }

        function draw() {
            const look = glintChart[document.documentElement.dataset.look];
            if (state.drawn) state.drawn.dispose();
            state.drawn = echarts.init(plot, null, {renderer: 'svg'});
            const option = glintChart.option(chart, look, false, plot.clientWidth);
            option.tooltip = {
                trigger: 'item', confine: true, backgroundColor: look.ground, borderColor: look.line,
                textStyle: {color: look.text, fontSize: 12},
                formatter: e => tip(e.seriesIndex, e.data),
            };
            option.series.push({id: 'chosen', type: 'scatter', silent: true, symbolSize: 18, z: 9, data: [], animation: false,
                itemStyle: {color: 'transparent', borderColor: look.text, borderWidth: 2}});
            state.drawn.setOption(option);
            const place = e => points.findIndex(q => places[q.series] === e.seriesIndex && q.i === e.data?.point);
            state.drawn.on('mouseover', e => { const k = place(e); if (k >= 0) go(k); });
            state.drawn.on('mouseout', () => go(state.kept));
            state.drawn.on('click', e => { const k = place(e); if (k >= 0) choose(k); });
            ring();
        }

        function tip(index, d) {
            const q = points.find(q => places[q.series] === index && q.i === d?.point);
            if (!q) return null;
            return element('div', null, element('b', null, q.p.name || q.s.name), terms(keys.map(key => coordinate(key, q.p)), null));
        }

        plot.addEventListener('keydown', e => {
            const step = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1}[e.key];
            if (step && order.length) {
                const at = order.indexOf(state.at);
                go(order[at < 0 ? (step > 0 ? 0 : order.length - 1) : (at + step + order.length) % order.length]);
            } else if (e.key === 'Enter' && state.at >= 0) choose(state.at);
            else if (e.key === 'Escape') choose(-1);
            else return;
            e.preventDefault();
        });

        const table = points.length ? pointTable(read, points, keys, coordinate, choose) : null;
        show(-1);
        charts.push({
            keep,
            placeOf: name => points.findIndex(q => q.p.name === name),
            draw() {
                try {
                    draw();
                } catch (error) {
                    plot.replaceChildren(element('p', {class: 'note'}, `this chart cannot be drawn: ${error.message}`));
                }
            },
        });
        return element('section', null,
            chart.title ? element('h3', null, chart.title) : null,
            element('div', {class: detailed ? 'chart detailed' : 'chart'}, plot, detailed ? aside : null),
            read.left ? element('p', {class: 'faint'}, `${read.left} point${read.left > 1 ? 's' : ''} without a place on these axes (not known, or at or below zero of a logarithmic axis) ${read.left > 1 ? 'are' : 'is'} not drawn.`) : null,
            table ? element('details', null, element('summary', null, `Its ${points.length} points as a table`), table) : null);
    }

    function pointTable(read, points, keys, coordinate, keep) {
        const names = [];
        for (const {p} of points) for (const [name, , unit] of list(p.values)) if (!names.some(n => n.name === name)) names.push({name, unit});
        const several = read.series.length > 1, named = points.some(({p}) => p.name);
        const columns = [...(several ? [{name: 'series'}] : []), ...(named ? [{name: 'point'}] : []),
            ...keys.map(key => ({name: coordinate(key, points[0].p)[0], unit: read[key].unit})), ...names];
        const rows = points.map(({p, s}) => [...(several ? [s.name] : []), ...(named ? [p.name] : []),
            ...keys.map(key => coordinate(key, p)[1]),
            ...names.map(n => (list(p.values).find(v => v[0] === n.name) || [])[1])]);
        return tableElement({columns, rows}, keep);
    }

    /* ---- Players ---- */

    function playerElement(player) {
        const tracks = list(player.tracks).filter(t => t && list(t.pictures).every(sourceOf)), frames = list(player.frames).map(glintChart.text);
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
            if (picture) image.src = sourceOf(picture);
            image.alt = glintChart.text(picture?.caption);
            caption.textContent = [`${image.alt} (${state.frame + 1} of ${frames.length})`, ...worst].join(', ');
            caption.className = worst.length ? 'worst' : '';
            slider.value = state.frame;
            key.replaceChildren(...(tracks[state.track].key ? [glintStage.key(element, [tracks[state.track].key])] : []));
            choices.forEach((b, i) => b.setAttribute('aria-pressed', String(i === state.track)));
            play.textContent = state.timer ? 'Pause' : 'Play';
        }

        /* The charts go along, but not ten times a second. */
        function seek(frame) {
            stop();
            state.frame = Math.min(frames.length - 1, Math.max(0, frame));
            show();
            for (const c of charts) { const k = c.placeOf(frames[state.frame]); if (k >= 0) c.keep(k); }
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
        players.push({go: frame => { const k = frames.indexOf(glintChart.text(frame)); if (k >= 0 && k !== state.frame) { stop(); state.frame = k; show(); } }});
        show();
        return element('section', {class: 'player'},
            element('div', {class: 'bar', role: 'toolbar', 'aria-label': name}, play, rate, ...choices,
                ...marks.map(m => element('button', {type: 'button', click: () => seek(m.frame)}, `${glintChart.text(m.label)}: ${frames[m.frame]}`))),
            element('div', {class: 'track'}, slider, ...ticks), shown);
    }

    /* ---- The page ---- */

    const blocks = {
        text: b => element('p', null, b.text),
        heading: b => element('h3', null, b.heading),
        note: b => element('p', {class: 'note'}, b.note),
        code: b => element('pre', {tabindex: 0}, b.code),
        table: b => tableElement(b.table),
        pictures: picturesElement,
        stage: b => glintStage.stage(b.stage, {element, list, sourceOf}),
        chart: b => chartElement(b.chart),
        fold: b => foldElement(b.fold),
        player: b => playerElement(b.player),
    };

    /* What is in it is built when it is opened, so that it costs nothing before, and charts have a width. */
    function foldElement(fold) {
        const e = element('details', {class: 'fold'}, element('summary', null, fold.title)), kept = `${page.title}|fold ${folds++}`;
        e.open = page.refresh > 0 && glintStage.recall(kept).open === true;
        e.addEventListener('toggle', () => {
            if (page.refresh > 0) glintStage.store(kept, {open: e.open});
            if (!e.open || e.children.length > 1) return;
            const before = charts.length;
            e.append(...list(fold.blocks).map(blockElement).filter(b => b));
            charts.slice(before).forEach(c => c.draw());
        });
        return e;
    }

    /* A block that cannot be shown says so, and the others stay. */
    function blockElement(block) {
        const kind = Object.keys(blocks).find(k => block && block[k] !== undefined);
        try {
            return kind ? blocks[kind](block) : null;
        } catch (error) {
            return element('p', {class: 'note'}, `a ${kind} cannot be shown: ${error.message}`);
        }
    }

    function setLook(look) {
        document.documentElement.dataset.look = look;
        toggle.textContent = look === 'dark' ? 'Light' : 'Dark';
        charts.forEach(c => c.draw());
    }

    const toggle = element('button', {type: 'button', id: 'look', click: () => setLook(document.documentElement.dataset.look === 'dark' ? 'light' : 'dark')});
    document.title = glintChart.text(page.title);
    const parts = list(page.sections).filter(s => s && typeof s === 'object');
    const sections = parts.map((s, i) => element('section', {id: `s${i}`}, s.title ? element('h2', null, s.title) : null,
        ...list(s.blocks).map(blockElement)));
    document.body.replaceChildren(
        element('header', null, toggle, element('h1', null, page.title), terms(list(page.facts), null),
            sections.length > 2 ? element('nav', {'aria-label': 'sections'}, ...parts.map((s, i) => s.title ? element('a', {href: `#s${i}`}, s.title) : null)) : null),
        element('main', null, ...sections), view.dialog);
    const dark = matchMedia('(prefers-color-scheme: dark)');
    setLook(dark.matches ? 'dark' : 'light');
    dark.addEventListener('change', () => setLook(dark.matches ? 'dark' : 'light'));
    addEventListener('resize', () => charts.forEach(c => c.draw()));
    if (page.refresh > 0) glintStage.refresh(page.refresh);
    document.documentElement.dataset.ready = 'yes';
})();
