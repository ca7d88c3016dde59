/* The page of glint live: how an image becomes a picture. Exposure, display and view, kind and range of false colours. */
glintLive.view = (function () {
    'use strict';
    const {element} = glintParts;

    function labelled(text, ...controls) { return element('label', null, element('span', null, text), ...controls); }

    function choice(name, values, change) {
        return element('select', {'aria-label': name, change: event => change(event.target.value)}, ...values.map(v => element('option', {value: v}, v)));
    }

    function exposure(store) {
        const slider = element('input', {type: 'range', min: -10, max: 10, step: 0.25, 'aria-label': 'exposure in EV',
            input: () => store.setLook({exposure: +slider.value})});
        const reset = element('button', {type: 'button', 'aria-label': 'exposure back to 0 EV', click: () => store.setLook({exposure: 0})});
        return {e: element('label', {class: 'exposure'}, element('span', null, 'Exposure'), slider, reset), draw({exposure}) {
            slider.value = exposure || 0;
            slider.setAttribute('aria-valuetext', `${slider.value} EV`);
            reset.textContent = `${exposure > 0 ? '+' : ''}${String(exposure || 0).replace('-', '\u2212')} EV`;
            reset.disabled = !exposure;
        }};
    }

    function display(store) {
        const {registry} = store, displays = registry.displays || [];
        const viewsOf = name => (displays.find(d => d.name === name) || {views: []}).views;
        const current = look => look.display || registry.display;
        const select = choice('display', displays.map(d => d.name), name => store.setLook({display: name, view: viewsOf(name)[0] || null}));
        const view = element('select', {'aria-label': 'view of the display', change: () => store.setLook({display: current(store.look), view: view.value})});
        return {e: element('div', {class: 'pair'}, labelled('Display', select), labelled('View', view)), draw(look) {
            select.value = current(look);
            view.replaceChildren(...viewsOf(current(look)).map(v => element('option', {value: v}, v)));
            view.value = look.view || registry.view;
        }};
    }

    /* What stands in a field of a range: a finite number, or nothing for an end that follows the image. */
    function numberOf(text) {
        const value = Number(text.trim().replace('\u2212', '-').replace(',', '.'));
        return text.trim() === '' ? null : Number.isFinite(value) ? value : undefined;
    }

    /* The members of a look that hold the range of what is seen: of the picture's false colours, or of the heat map. */
    const PICTURE = {low: 'low', high: 'high', scale: 'scale'}, HEAT = {low: 'heatLow', high: 'heatHigh', scale: 'heatScale'};
    const nothing = keys => Object.fromEntries(Object.values(keys).map(key => [key, null]));

    function range(store) {
        let keys = PICTURE, seen = null; /* seen: what answer of the server the range is of */
        const kinds = choice('kind of picture', store.registry.kinds || [], kind => store.setLook({kind, ...nothing(PICTURE)}));
        const fields = ['low', 'high'].map(end => element('input', {
            type: 'text', inputmode: 'decimal', size: 11, 'aria-label': `${end} end of the range`, placeholder: 'auto',
            change: event => {
                const value = numberOf(event.target.value), [low, high] = rangeWith(end, value);
                const wrong = value === undefined || (low !== null && low >= high);
                event.target.setAttribute('aria-invalid', String(wrong));
                why.textContent = value === undefined ? 'A number is expected, or nothing.' : wrong ? 'The low end has to be below the high one.' : '';
                if (!wrong) store.setLook({[keys.low]: low, [keys.high]: high});
            }}));
        /* Both ends or none: one that was not set is the one that is shown, and without one the other follows the image, too. */
        const rangeWith = (end, value) => value === null ? [null, null]
            : ['low', 'high'].map((e, i) => e === end ? value : store.look[keys[e]] ?? seen?.range?.[i] ?? null);
        const scale = element('select', {'aria-label': 'scale of the range', change: () => store.setLook({[keys.scale]: scale.value || null})},
            element('option', {value: ''}, 'auto'), element('option', {value: 'linear'}, 'linear'), element('option', {value: 'log'}, 'logarithmic'));
        const auto = element('button', {type: 'button', click: () => store.setLook(nothing(keys))}, 'Auto range');
        const why = element('span', {class: 'why', role: 'alert'}), of = element('span', {class: 'faint'}, 'Heat map');
        const ends = element('div', {class: 'pair'}, of, labelled('Low', fields[0]), labelled('High', fields[1]), labelled('Scale', scale), auto, why);
        const kind = labelled('Kind', kinds);
        return {e: element('div', {class: 'pair'}, kind, ends), draw(look, picture, heat) {
            const before = keys;
            seen = heat || picture;
            keys = heat ? HEAT : PICTURE;
            if (keys !== before) why.textContent = '';
            kinds.value = look.kind || kinds.options[0]?.value;
            kind.hidden = !!heat;
            of.hidden = !heat;
            fields.forEach((field, i) => {
                const value = look[[keys.low, keys.high][i]];
                if (keys === before && field === document.activeElement && field.getAttribute('aria-invalid') === 'true') return;
                field.value = value === null ? '' : String(value).replace('-', '\u2212');
                field.placeholder = seen?.range ? `auto: ${glintChart.number(seen.range[i])}` : 'auto';
                field.setAttribute('aria-invalid', 'false');
            });
            scale.value = look[keys.scale] || '';
            auto.disabled = Object.values(keys).every(key => look[key] === null);
            /* an image that is shown in its own colours has no range */
            ends.hidden = !!seen && !seen.range && auto.disabled;
        }};
    }

    /* The values of /api/v1/picture that a look asks for. */
    function query(look) {
        const words = new URLSearchParams();
        for (const key of ['exposure', 'display', 'view', 'kind', 'low', 'high', 'scale'])
            if (look[key] !== null && look[key] !== undefined && !(key === 'exposure' && look[key] === 0)) words.set(key, look[key]);
        return words;
    }

    /* The part of a look that a heat map is drawn by. */
    const heatOf = look => ({low: look[HEAT.low], high: look[HEAT.high], scale: look[HEAT.scale]});

    /* An element whose draw(picture, heat) shows store.look, given the heads of the picture and of the heat map if that is seen instead. */
    function make(store) {
        const controls = [exposure(store), display(store), range(store)];
        const e = element('fieldset', {class: 'live-view'}, element('legend', null, 'View'), ...controls.map(c => c.e));
        let shown = [null, null];
        e.draw = (picture, heat) => {
            shown = [picture, heat];
            controls.forEach(c => c.draw(store.look, ...shown));
        };
        store.on('look', () => e.draw(...shown));
        e.draw(null, null);
        return e;
    }

    return Object.assign(make, {query, heatOf});
})();
