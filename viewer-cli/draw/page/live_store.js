/* What the page of glint live knows: registry, state, results, look; who wants to hear of a change; undo and redo; the permalink.
   glintLive.store(registry) makes one; live_runs.js sends its states to the server. */
glintLive.store = (function () {
    'use strict';
    const {api} = glintLive, LINK_MS = 400, KEPT_STEPS = 500;

    function copy(v) { return v === undefined ? undefined : JSON.parse(JSON.stringify(v)); }

    /* Texts that are equal if the states are: members in one order. */
    function keyOf(state) {
        const sorted = o => Object.keys(o || {}).sort().map(k => [k, o[k]]);
        return JSON.stringify([state.capture, state.preset, sorted(state.use), sorted(state.set), [...(state.skip || [])].sort(), [...(state.force || [])].sort()]);
    }

    function complete(state, start) {
        return {...bare(start.capture || 0, start.preset), ...copy(state)};
    }

    /* A preset as it is. */
    function bare(capture, preset) { return {capture, preset, use: {}, set: {}, skip: [], force: []}; }

    /* ---- The permalink: #s= and base64url of {"state", "look", "b"}: what B is, if there is one ---- */

    function encode(value) {
        const bytes = new TextEncoder().encode(JSON.stringify(value));
        return btoa(Array.from(bytes, b => String.fromCharCode(b)).join('')).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
    }

    function decode(text) {
        try {
            const bytes = Uint8Array.from(atob(text.replace(/-/g, '+').replace(/_/g, '/')), c => c.charCodeAt(0));
            const value = JSON.parse(new TextDecoder().decode(bytes));
            return value && typeof value === 'object' ? value : null;
        } catch {
            return null;
        }
    }

    /* {"state", "look"} of the address, or null. */
    function linked() {
        const part = location.hash.slice(1).split('&').find(p => p.startsWith('s='));
        return part ? decode(part.slice(2)) : null;
    }

    const LOOK = {image: null, exposure: 0, display: null, view: null, kind: null, low: null, high: null, scale: null,
        heatLow: null, heatHigh: null, heatScale: null, mode: null, zoom: 0, x: null, y: null};

    const TEXTS = ['image', 'display', 'view', 'kind', 'scale', 'heatScale', 'mode'], INTEGERS = ['zoom', 'x', 'y'];

    /* Only members that are known, of the kinds that they have. */
    function lookOf(given) {
        const look = {...LOOK};
        for (const key of Object.keys(LOOK)) {
            const value = given?.[key];
            if (TEXTS.includes(key) ? typeof value === 'string' : INTEGERS.includes(key) ? Number.isInteger(value) : Number.isFinite(value)) look[key] = value;
        }
        return look;
    }

    /* ---- Undo ---- */

    /* States before and after the one that is shown. Changes of one drag are one step. */
    function trail() {
        const past = [], future = [];
        let drag = null;
        return {
            past, future,
            push(state, of) {
                if (of === undefined || of !== drag) past.push(state);
                if (past.length > KEPT_STEPS) past.shift();
                drag = of === undefined ? null : of;
                future.length = 0;
            },
            settle() { drag = null; },
            step(from, to, now) {
                drag = null;
                if (!from.length) return null;
                to.push(now);
                return from.pop();
            },
        };
    }

    function make(registry) {
        const listeners = new Map(), steps = trail();
        const store = {registry, client: api.client, state: null, result: null, error: null, pinned: null, truth: null, look: null,
            besides: [], slots: [], command: '', progress: null, effect: null, playing: false};
        let timer = 0;

        /* f is called after each change of what `name` says; the answer takes it away again. */
        store.on = (name, f) => {
            if (!listeners.has(name)) listeners.set(name, new Set());
            listeners.get(name).add(f);
            return () => listeners.get(name).delete(f);
        };
        /* A part of the page that fails leaves the others, and the requests under way, as they are. */
        store.emit = name => {
            for (const f of [...(listeners.get(name) || [])])
                try {
                    f(store);
                } catch (error) {
                    console.error(error);
                }
        };

        store.link = () => `${location.origin}${location.pathname}#s=${encode({state: store.state, look: store.look, ...(store.pinned ? {b: linkOf(store.pinned)} : {})})}`;
        const linkOf = ({title, of, effect, result}) => of ? {title, of, effect} : {title, state: result.state};
        function keepLink() {
            clearTimeout(timer);
            timer = setTimeout(() => history.replaceState(null, '', store.link()), LINK_MS);
        }

        store.on('pinned', keepLink);

        /* Shows a state without a step for undo: frames of a shot, what the server made of a state. */
        store.showState = state => {
            store.state = complete(state, registry.start);
            store.emit('state');
            keepLink();
        };
        store.setState = (state, {drag} = {}) => {
            const next = complete(state, registry.start);
            if (keyOf(next) === keyOf(store.state)) return;
            steps.push(store.state, drag);
            store.showState(next);
            store.emit('changed');
        };
        /* change(state => { state.set[name] = 3; }, {drag: name}): calls with the same drag are one step until settle(). */
        store.change = (f, options) => {
            const next = copy(store.state);
            store.setState(f(next) || next, options);
        };
        store.settle = () => steps.settle();

        /* The frame of a shot is no step, and stays. */
        function walk(from, to) {
            const state = steps.step(from, to, store.state);
            if (!state) return;
            store.showState({...state, capture: store.state.capture});
            store.emit('changed');
        }
        store.undo = () => walk(steps.past, steps.future);
        store.redo = () => walk(steps.future, steps.past);
        store.canUndo = () => steps.past.length > 0;
        store.canRedo = () => steps.future.length > 0;
        /* Takes back a step that the server refused, which redo shall not bring again. */
        store.dropStep = state => {
            if (steps.past.length && keyOf(steps.past.at(-1)) === keyOf(state)) steps.past.pop();
            steps.settle();
            store.showState(state);
        };

        store.setLook = part => {
            store.look = {...store.look, ...part};
            store.emit('look');
            keepLink();
        };
        /* What the server does for the page beside replays, in a word. */
        store.setBesides = (what, yes) => {
            store.besides = yes ? [...new Set([...store.besides, what])] : store.besides.filter(w => w !== what);
            store.emit('progress');
        };
        store.setError = error => {
            store.error = error;
            store.emit('error');
        };
        store.setEffect = effect => {
            if (effect === store.effect) return;
            store.effect = effect;
            store.emit('effect');
        };

        store.lookOf = lookOf;
        store.restore = () => {
            const given = linked();
            store.look = lookOf(given?.look);
            return given?.state && typeof given.state === 'object' ? given.state : null;
        };
        store.state = complete(registry.start, registry.start);
        return store;
    }

    return Object.assign(make, {keyOf, copy, bare, linked});
})();
