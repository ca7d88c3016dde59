/* The values of pixels: unpacking those of page_values, and saying them in words and in a table. */
const glintValues = (function () {
    'use strict';
    const {element} = glintParts;

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

    /* {"title": of the pixel, "channels": [NAME, …], "unit", "rows": [[caption, [TEXT, …]], …]}. */
    function table({title, channels, unit, rows}) {
        return element('table', null,
            element('thead', null, element('tr', null, element('th', {scope: 'col'}, title),
                ...channels.map(c => element('th', {scope: 'col', class: 'number'}, c)), element('th', null, unit || ''))),
            element('tbody', null, ...rows.map(([caption, row]) => element('tr', null, element('th', {scope: 'row'}, caption),
                ...row.map(text => element('td', {class: 'number'}, text)), element('td')))));
    }

    /* What page_values kept of these pictures at a pixel, as table() wants it; `pair`: two whose difference is said too. */
    async function read(pictures, pair, x, y) {
        const v = pictures[0].values;
        const at = await Promise.all(pictures.map(async p => {
            if (!p.bytes) p.bytes = inflate(p.values);
            return valuesAt(p.values, await p.bytes, x, y);
        }));
        const rows = at.map((row, i) => [pictures[i].caption, v.channels.map(c => words(row[c], v.names))]);
        const [left, right] = pair.map(p => pictures.indexOf(p));
        if (left >= 0 && right >= 0 && left !== right)
            rows.push([`${glintChart.text(pair[1].caption)} \u2212 ${glintChart.text(pair[0].caption)}`,
                v.channels.map(c => c in at[left] && c in at[right] ? change(at[left][c], at[right][c], v.names) : '\u2013')]);
        const kept = v.every > 1 ? ` (of ${x - x % v.every},${y - y % v.every}: one of ${v.every} \u00d7 ${v.every} is kept)` : '';
        return {title: `${x},${y}${kept}`, channels: v.channels, unit: v.unit, rows};
    }

    return {words, change, table, read};
})();
