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

    function range(store) {
        const kinds = choice('kind of picture', store.registry.kinds || [], kind => store.setLook({kind, low: null, high: null, scale: null}));
        const fields = ['low', 'high'].map(end => element('input', {
            type: 'text', inputmode: 'decimal', size: 11, 'aria-label': `${end} end of the range`, placeholder: 'auto',
            change: event => {
                const value = numberOf(event.target.value), look = {...store.look, [end]: value};
                const wrong = value === undefined || (look.low !== null && look.high !== null && look.low >= look.high);
                event.target.setAttribute('aria-invalid', String(wrong));
                why.textContent = value === undefined ? 'A number is expected, or nothing.' : wrong ? 'The low end has to be below the high one.' : '';
                if (!wrong) store.setLook({[end]: value});
            }}));
        const scale = element('select', {'aria-label': 'scale of the range', change: () => store.setLook({scale: scale.value || null})},
            element('option', {value: ''}, 'auto'), element('option', {value: 'linear'}, 'linear'), element('option', {value: 'log'}, 'logarithmic'));
        const auto = element('button', {type: 'button', click: () => store.setLook({low: null, high: null, scale: null})}, 'Auto range');
        const why = element('span', {class: 'why', role: 'alert'});
        const ends = element('div', {class: 'pair'}, labelled('Low', fields[0]), labelled('High', fields[1]), labelled('Scale', scale), auto, why);
        return {e: element('div', {class: 'pair'}, labelled('Kind', kinds), ends), draw(look, picture) {
            kinds.value = look.kind || kinds.options[0]?.value;
            fields.forEach((field, i) => {
                const value = look[['low', 'high'][i]];
                if (field === document.activeElement && field.getAttribute('aria-invalid') === 'true') return;
                field.value = value === null ? '' : String(value).replace('-', '\u2212');
                field.placeholder = picture?.range ? `auto: ${glintChart.number(picture.range[i])}` : 'auto';
                field.setAttribute('aria-invalid', 'false');
            });
            scale.value = look.scale || '';
            auto.disabled = look.low === null && look.high === null && !look.scale;
            /* an image that is shown in its own colours has no range */
            ends.hidden = !!picture && !picture.range && auto.disabled;
        }};
    }

    /* The values of /api/v1/picture that a look asks for. */
    function query(look) {
        const words = new URLSearchParams();
        for (const key of ['exposure', 'display', 'view', 'kind', 'low', 'high', 'scale'])
            if (look[key] !== null && look[key] !== undefined && !(key === 'exposure' && look[key] === 0)) words.set(key, look[key]);
        return words;
    }

    /* An element whose draw(picture) shows store.look, given the head of the picture that is shown. */
    function make(store) {
        const controls = [exposure(store), display(store), range(store)];
        const e = element('fieldset', {class: 'live-view'}, element('legend', null, 'View'), ...controls.map(c => c.e));
        let shown = null;
        e.draw = picture => {
            shown = picture === undefined ? shown : picture;
            controls.forEach(c => c.draw(store.look, shown));
        };
        store.on('look', () => e.draw());
        e.draw(null);
        return e;
    }

    return Object.assign(make, {query});
})();
