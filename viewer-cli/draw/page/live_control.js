/* The control of one parameter, made from what the registry says of it: a slider with a field for exact values, a box, a choice.
   glintLive.control(parameter, {value, set(value, drag), settle, refresh, revert}) has show({value, preset, refusal}). */
glintLive.control = (function () {
    'use strict';
    const {element} = glintParts;
    const EACH = 512;     /* integers up to so many have a place each on the slider */
    const PARTS = 200;    /* of a linear scale */
    const PER_DECADE = [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8];
    const WIDE = 200;     /* highest over default from which on a scale is logarithmic */
    let drags = 0;

    function plain(v) { return +v.toPrecision(12); }

    /* A step of 1, 2 or 5 times a power of ten. */
    function niceStep(range) {
        const rough = range / PARTS, power = 10 ** Math.floor(Math.log10(rough)), part = rough / power;
        return (part > 5 ? 10 : part > 2 ? 5 : part > 1 ? 2 : 1) * power;
    }

    /* Where a logarithmic scale that starts at zero has its first place above it. */
    function leastOf({lowest, highest, default: usual}) {
        if (lowest > 0) return lowest;
        const least = Math.min(highest * 1e-6, 1e-3);
        return usual > 0 ? Math.min(Math.max(least, usual * 1e-4), usual / 100) : least;
    }

    function isLog({type, lowest, highest, default: usual}) {
        if (lowest < 0) return false;
        if (type === 'int') return highest - lowest > EACH;
        if (lowest > 0 && highest / lowest > WIDE) return true;
        return highest > 100 || (usual > 0 && highest / usual > WIDE);
    }

    function logPlaces(least, highest, integer) {
        const places = [];
        for (let e = Math.floor(Math.log10(least)); e <= Math.ceil(Math.log10(highest)); e++)
            for (const m of PER_DECADE) {
                const v = integer ? Math.round(m * 10 ** e) : plain(m * 10 ** e);
                if (v >= least && v <= highest) places.push(v);
            }
        return places;
    }

    /* The values that a slider stops at: the range's ends, what stands between them, and those that it has to be able to come back to. */
    function placesOf(p, also) {
        const integer = p.type === 'int', places = [p.lowest, p.highest, p.default, ...also];
        if (isLog(p)) places.push(...logPlaces(integer ? Math.max(1, p.lowest) : leastOf(p), p.highest, integer));
        else {
            const step = integer ? 1 : niceStep(p.highest - p.lowest), n = Math.floor((p.highest - p.lowest) / step + 1e-9);
            for (let i = 0; i <= n; i++) places.push(plain(p.lowest + i * step));
        }
        return [...new Set(places.filter(v => Number.isFinite(v) && v >= p.lowest && v <= p.highest))].sort((a, b) => a - b);
    }

    function nearest(places, v) {
        let low = 0, high = places.length - 1;
        while (high - low > 1) {
            const middle = (low + high) >> 1;
            if (places[middle] <= v) low = middle; else high = middle;
        }
        return Math.abs(places[high] - v) < Math.abs(v - places[low]) ? high : low;
    }

    function text(v) {
        return typeof v === 'boolean' ? (v ? 'on' : 'off') : typeof v === 'number' ? String(plain(v)) : String(v);
    }

    function rangeText(p) {
        return p.type === 'bool' ? 'on or off' : p.choices ? p.choices.join(', ') : `${text(p.lowest)} to ${text(p.highest)}`;
    }

    function unitOf(p) { return p.unit && p.unit !== '1' ? p.unit : ''; }

    /* What there is to read about a parameter: help, range, default, source. */
    function helpElement(p, attributes) {
        const unit = unitOf(p);
        return element('div', {class: 'help', ...attributes}, element('b', null, p.name), element('span', null, p.help),
            element('span', {class: 'faint'}, [`range ${rangeText(p)}${unit ? ` ${unit}` : ''}`, `default ${text(p.default)}`,
                ...(p.assumed ? ['assumed: captures do not contain it'] : []), ...(p.source ? [`source: ${p.source}`] : [])].join(' \u00b7 ')));
    }

    /* A slider over places, and a field beside it. */
    function numberControl(p, act, label) {
        let places = placesOf(p, []), preset = p.default, drag = '', typing = false;
        const slider = element('input', {type: 'range', min: 0, step: 1, 'aria-label': label});
        const field = element('input', {type: 'text', inputmode: 'decimal', class: 'exact', 'aria-label': `${label}, exact value`,
            autocomplete: 'off', spellcheck: 'false'});
        const marks = [element('i', {class: 'mark default', title: `default: ${text(p.default)}`}), element('i', {class: 'mark preset'})];
        const track = element('span', {class: 'track'}, slider, ...marks);

        function place(mark, v) {
            mark.style.setProperty('--at', nearest(places, v) / Math.max(1, places.length - 1));
        }
        function setPlaces(also) {
            preset = also;
            places = placesOf(p, [also]);
            slider.max = places.length - 1;
            place(marks[0], p.default);
            place(marks[1], preset);
            marks[1].hidden = preset === p.default;
            marks[1].title = `preset: ${text(preset)}`;
        }
        setPlaces(p.default);

        slider.addEventListener('pointerdown', () => { drag = `drag ${++drags}`; });
        slider.addEventListener('keydown', () => { if (!drag) drag = `keys ${++drags}`; });
        slider.addEventListener('blur', () => { drag = ''; act.settle(); });
        slider.addEventListener('pointerup', () => { drag = ''; act.settle(); });
        slider.addEventListener('input', () => {
            const v = places[+slider.value];
            field.value = text(v);
            slider.setAttribute('aria-valuetext', `${text(v)} ${unitOf(p)}`.trim());
            act.set(v, drag || `drag ${++drags}`);
        });
        /* What is no number is sent as it is: the server says what it expected. */
        function enter() {
            setTyping(false);
            const given = field.value.trim().replace('\u2212', '-'), v = given !== '' && Number.isFinite(+given) ? +given : given;
            act.set(v === '' ? preset : v);
        }
        const setTyping = yes => { typing = yes; field.toggleAttribute('data-typing', yes); };
        field.addEventListener('input', () => setTyping(true));
        field.addEventListener('change', enter);
        /* What was typed and taken back by hand is no change, which the browser does not tell. */
        field.addEventListener('blur', () => {
            if (!typing) return;
            setTyping(false);
            act.refresh();
        });
        field.addEventListener('keydown', e => {
            const step = {ArrowUp: 1, ArrowDown: -1}[e.key];
            if (!step) return;
            e.preventDefault();
            setTyping(false);
            const at = nearest(places, +field.value);
            act.set(places[Math.min(places.length - 1, Math.max(0, at + step))], 'steps');
        });
        return {parts: [track, field], focus: slider, show(v, of, refused) {
            if (of !== preset) setPlaces(of);
            if (typeof v === 'number') {
                if (!refused && !typing && field.value !== text(v)) field.value = text(v);
                if (places[+slider.value] !== v) slider.value = nearest(places, v);
                slider.setAttribute('aria-valuetext', `${text(v)} ${unitOf(p)}`.trim());
            }
            field.setAttribute('aria-invalid', String(!!refused));
        }};
    }

    function boxControl(p, act, label) {
        const box = element('input', {type: 'checkbox', 'aria-label': label, change: () => act.set(box.checked)});
        return {parts: [element('span', {class: 'box'}, box)], focus: box, show(v) { box.checked = v === true || v === 1; }};
    }

    function choiceControl(p, act, label) {
        const select = element('select', {'aria-label': label, change: () => act.set(select.value)}, ...p.choices.map(c => element('option', {value: c}, c)));
        return {parts: [select], focus: select, show(v) { select.value = v; }};
    }

    function make(p, act) {
        const short = p.name.slice(p.name.indexOf('.') + 1);
        const inner = p.choices ? choiceControl(p, act, p.name) : p.type === 'bool' ? boxControl(p, act, p.name) : numberControl(p, act, p.name);
        const help = helpElement(p, {id: `help ${p.name}`.replace(/[^\w]/g, '-'), hidden: ''});
        const name = element('button', {type: 'button', class: 'name', 'aria-expanded': 'false', title: glintChart.text(p.help), click: () => {
            help.hidden = !help.hidden;
            name.setAttribute('aria-expanded', String(!help.hidden));
        }}, short);
        const revert = element('button', {type: 'button', class: 'revert', click: () => { act.revert(); inner.focus.focus(); }}, '\u21ba');
        const refusal = element('p', {class: 'refusal', role: 'alert', hidden: ''});
        const row = element('div', {class: `parameter ${p.choices ? 'choice' : p.type}`, 'data-name': p.name}, name,
            element('span', {class: 'value'}, ...inner.parts), element('span', {class: 'unit', title: unitOf(p) || null}, unitOf(p)), revert, refusal, help);
        inner.focus.setAttribute('aria-describedby', help.id);
        return {row, parameter: p, show({value, preset, refused}) {
            inner.show(value, preset, refused);
            const differs = value !== preset;
            row.classList.toggle('differs', differs);
            revert.hidden = !differs;
            revert.title = `back to the preset's ${text(preset)}`;
            revert.setAttribute('aria-label', `${p.name}: back to the preset's ${text(preset)}`);
            refusal.hidden = !refused;
            refusal.textContent = refused ? glintChart.text(refused) : '';
        }};
    }

    return Object.assign(make, {placesOf, text, helpElement});
})();
