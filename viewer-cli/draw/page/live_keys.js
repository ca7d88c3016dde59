/* Keys of the page of glint live, and the list of them that "?" opens. glintLive.keys(store) listens, and is the dialog's element. */
glintLive.keys = (function () {
    'use strict';
    const {element} = glintParts, {HEAT} = glintLive.picture;

    function go(id, inner) {
        const panel = document.getElementById(id);
        panel?.scrollIntoView({block: 'nearest'});
        (inner && panel?.querySelector(inner) || panel)?.focus();
    }

    /* [keys as they are shown, what they do, whether an event is meant, the deed] */
    function table(store, look, help) {
        const plain = key => e => !e.ctrlKey && !e.metaKey && !e.altKey && e.key === key;
        const control = (key, shift) => e => (e.ctrlKey || e.metaKey) && !e.altKey && e.key.toLowerCase() === key && e.shiftKey === shift;
        const shot = store.registry.captures.length > 1;
        return [
            ['Ctrl+Z', 'undo', control('z', false), () => store.undo()],
            ['Ctrl+Shift+Z', 'redo', e => control('z', true)(e) || control('y', false)(e), () => store.redo()],
            ['/', 'search passes and parameters', plain('/'), () => document.getElementById('search').focus()],
            ['1', 'go to the pipeline', plain('1'), () => go('pipeline')],
            ['2', 'go to the picture', plain('2'), () => go('picture', '.frame')],
            ['3', 'go to the pixel', plain('3'), () => go('pixel')],
            ['4', 'go to the figures', plain('4'), () => go('figures')],
            ['5', 'go to command line, preset, report', plain('5'), () => go('out')],
            ['p', 'pin this state as B', plain('p'), () => store.pinState(store.state)],
            ['u', 'unpin B', plain('u'), () => store.unpin()],
            ['x', 'swap A and B', plain('x'), () => store.swap()],
            ['h', 'heat map of A and B, and back', plain('h'), () => store.pinned && store.setLook({mode: store.look.mode === HEAT ? 'slider' : HEAT})],
            ['m', 'measure error and times', plain('m'), () => store.measure()],
            ['c', 'copy the command line', plain('c'), () => store.copyCommand()],
            ...(shot ? [['[', 'frame before', plain('['), () => store.seek(-1)], [']', 'next frame', plain(']'), () => store.seek(1)],
                ['.', 'play, pause', plain('.'), () => store.togglePlay()]] : []),
            ['d', 'light or dark', plain('d'), () => look.button.click()],
            ['?', 'this list', plain('?'), () => help.showModal()],
        ];
    }

    /* In fields letters are text, and undo is that of the field; in lists letters choose. */
    function isMeant(event) {
        const e = event.target, writes = e.matches?.('textarea, select, [contenteditable], input:not([type=range]):not([type=checkbox])');
        return !writes || ((event.ctrlKey || event.metaKey) && (e.matches('select') || (e.matches('.exact') && !('typing' in e.dataset))));
    }

    return function (store, look) {
        const help = element('dialog', {class: 'help-keys', 'aria-label': 'Keys'});
        const keys = table(store, look, help);
        const entry = (name, what) => [element('dt', null, ...name.split('+').flatMap((k, i) => [i ? '+' : null, element('kbd', null, k)])), element('dd', null, what)];
        help.append(element('h2', null, 'Keys'), element('dl', null, ...keys.flatMap(([name, what]) => entry(name, what)),
            ...entry('Tab', 'the next control; arrow keys move sliders'),
            ...entry('\u2190 \u2191 \u2192 \u2193', 'in the picture: the pixel that is pointed at, with Shift by ten'),
            ...entry('Enter', 'in the picture: choose that pixel, as a click does, and trace its rays'),
            ...entry('Space', 'in the picture: show the other one of A and B; held while dragging: move the picture'),
            ...entry('Ctrl+Wheel', 'in the picture: zoom, as the keys plus and minus do'),
            ...entry('Esc', 'leaves the search, closes this list')), element('button', {type: 'button', click: () => help.close()}, 'Close'));
        document.addEventListener('keydown', event => {
            if (event.key === 'Escape' && event.target.id === 'search') {
                event.target.value = '';
                event.target.dispatchEvent(new Event('input'));
                go('pipeline');
                return;
            }
            if (document.querySelector('dialog[open]') || !isMeant(event)) return;
            const key = keys.find(([, , meant]) => meant(event));
            if (!key) return;
            event.preventDefault();
            key[3]();
        });
        return help;
    };
})();
