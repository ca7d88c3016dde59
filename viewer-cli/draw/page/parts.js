/* What pages are built from: elements, cells, tables, pictures, light and dark. Texts become text nodes, never markup.
   `own`: what is one page's alone; page() makes it. */
const glintParts = (function () {
    'use strict';
    const WORDS = ['infinite', 'minus infinite', 'not a number']; /* in columns of numbers */

    /* `sourceOf`: a PICTURE's URI, or null if it has none. Charts and players that plots.js makes for the page add themselves. */
    function page(sourceOf = () => null) { return {sourceOf, charts: [], players: []}; }

    function list(v) { return Array.isArray(v) ? v : []; }

    /* element('td', {class: 'number'}, child or text, …) */
    function element(name, attributes, ...children) {
        const e = document.createElement(name);
        for (const [key, value] of Object.entries(attributes || {}))
            if (typeof value === 'function') e.addEventListener(key, value);
            else if (value !== undefined && value !== null) e.setAttribute(key, glintChart.text(value));
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

    function terms(entries, other) {
        return element('dl', null, ...entries.flatMap(([name, cell, unit], i) => {
            const differs = other && other[i] && other[i][0] === name && valueOf(other[i][1]) !== valueOf(cell);
            return [element('dt', null, name), element('dd', {class: differs ? 'differs' : null}, cellText(cell), unit ? ` ${unit}` : '',
                intervalText(cell) ? element('div', {class: 'faint'}, intervalText(cell)) : null)];
        }));
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

    /* Enlarged; arrows flip to the others in place, so that differences jump out. */
    const view = {dialog: element('dialog'), image: element('img'), caption: element('p', {'aria-live': 'polite'}), all: [], at: 0, sourceOf: null};
    view.dialog.append(view.image, view.caption);
    view.dialog.addEventListener('click', () => view.dialog.close());
    view.dialog.addEventListener('keydown', e => {
        const step = {ArrowRight: 1, ArrowDown: 1, ' ': 1, ArrowLeft: -1, ArrowUp: -1}[e.key];
        if (!step || !view.all.length) return;
        e.preventDefault();
        enlarge(view.all, (view.at + step + view.all.length) % view.all.length, view.sourceOf);
    });

    function enlarge(pictures, at, sourceOf) {
        Object.assign(view, {all: pictures, at, sourceOf});
        view.image.src = sourceOf(pictures[at]);
        view.image.alt = glintChart.text(pictures[at].caption);
        view.caption.textContent = glintChart.text(pictures[at].caption) +
            (pictures.length > 1 ? `  (${at + 1} of ${pictures.length}, arrow keys flip)` : '');
        if (!view.dialog.isConnected) document.body.append(view.dialog);
        if (!view.dialog.open) view.dialog.showModal();
    }

    /* `more`: what flipping through the enlarged ones comes to after them. */
    function figures(pictures, own, more) {
        const known = list(pictures).filter(own.sourceOf), all = [...known, ...list(more).filter(own.sourceOf)];
        return known.map((p, i) => element('figure', null,
            element('button', {type: 'button', click: () => enlarge(all, i, own.sourceOf), 'aria-label': `enlarge ${glintChart.text(p.caption)}`},
                element('img', {src: own.sourceOf(p), alt: glintChart.text(p.caption), loading: 'lazy'})),
            element('figcaption', null, p.caption)));
    }

    /* ---- Light and dark ---- */

    /* A button between the two. `start`, once the page stands, takes the system's choice and follows it; charts are drawn in the
       new colours, and at the new width of the window. */
    function look(own) {
        function set(name) {
            document.documentElement.dataset.look = name;
            button.textContent = name === 'dark' ? 'Light' : 'Dark';
            own.charts.forEach(c => c.draw());
        }
        const button = element('button', {type: 'button', id: 'look', click: () => set(document.documentElement.dataset.look === 'dark' ? 'light' : 'dark')});
        const dark = matchMedia('(prefers-color-scheme: dark)');
        return {button, set, start() {
            set(dark.matches ? 'dark' : 'light');
            dark.addEventListener('change', () => set(dark.matches ? 'dark' : 'light'));
            addEventListener('resize', () => own.charts.forEach(c => c.draw()));
        }};
    }

    return {page, list, element, valueOf, decimalsOf, numberText, cellText, intervalText, tableElement, terms, figures, enlarge, look};
})();
