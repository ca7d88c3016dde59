/* The page of glint live: asks for the token where the address has none, then builds the page from the registry and asks for the first run. */
(function () {
    'use strict';
    const {element} = glintParts, {api} = glintLive;

    /* A page without a token, or with one that the server does not know. */
    function askToken(why) {
        const field = element('input', {type: 'password', id: 'token', autocomplete: 'off', spellcheck: 'false', 'aria-describedby': 'token-help', required: ''});
        const form = element('form', {class: 'token', submit: e => {
            e.preventDefault();
            const given = field.value.trim();
            if (!api.setToken(given.includes('#') ? given.split('#')[1].split('&')[0] : given)) askToken('This is no token.');
            else if (glintLive.shown) location.reload(); /* the page that was there listens on */
            else start();
        }}, element('h1', null, 'glint live'), why ? element('p', {class: 'message error', role: 'alert'}, why) : null,
        element('p', {id: 'token-help'}, 'This page needs the token of the server that it talks to. The command glint live prints an address such as ' +
            `${location.origin}/#\u2026: open that address, or paste it here.`),
        element('label', {for: 'token'}, 'Address or token'), field, element('button', {type: 'submit'}, 'Open'));
        document.body.replaceChildren(form);
        field.focus();
        document.documentElement.dataset.ready = 'token';
    }

    function fail(error) {
        if (error.status === 401) return askToken('The server does not know this token: it may have been started again since.');
        document.body.replaceChildren(element('main', {class: 'token'}, element('h1', null, 'glint live'),
            element('p', {class: 'message error', role: 'alert'}, error.message), element('button', {type: 'button', click: start}, 'Try again')));
        document.documentElement.dataset.ready = 'failed';
    }

    function listen(store) {
        api.stream(`/api/v1/events?client=${api.client}`, event => {
            if (event.event === 'progress' && event.client === api.client) store.progress = {what: event.what, done: event.done};
            else if (event.event === 'idle') store.progress = null;
            else if (event.event === 'changed') { store.emit('files'); store.request(); }
            else if (event.event === 'notice') store.notice(event.text);
            else if (event.event === 'gone') { store.gone = true; store.setGone(true); }
            else if (event.event === 'connected') {
                store.setGone(false);
                if (store.gone) comeBack(store);
                store.gone = false;
            } else return;
            store.emit('progress');
        });
    }

    /* The server that answers again may be another one: with the same token, but other captures, or runs of the same ids by other shaders. */
    async function comeBack(store) {
        try {
            if (JSON.stringify(await api.get('/api/v1/registry')) !== JSON.stringify(store.registry)) return location.reload();
        } catch { return; } /* it is gone again, which the stream says */
        store.emit('back');
        store.request();
    }

    /* Where there is room the panels stand beside the picture, else below it. */
    function build(store) {
        const own = glintLive.page = glintParts.page(), look = glintParts.look(own);
        const keys = glintLive.keys(store, look);
        const help = element('button', {type: 'button', id: 'keys', title: 'keys (?)', 'aria-label': 'keys', click: () => keys.showModal()}, '?');
        const panel = (id, title, inner) => element('section', {class: `panel ${id}-panel`, id, 'aria-label': title, tabindex: -1}, inner);
        look.start();
        const picture = panel('picture', 'Picture', glintLive.picture(store)), pixel = panel('pixel', 'Pixel', glintLive.pixel(store));
        pixel.append(element('p', {class: 'faint hint'}, 'Click a pixel of the picture, or press Enter at one, to see its rays here.'));
        document.body.classList.add('live');
        document.body.replaceChildren(glintLive.bar(store, [help, look.button]), glintLive.notes(store),
            element('main', {class: 'panels'}, glintLive.pipeline(store),
                element('div', {class: 'rest'}, element('div', {class: 'middle'}, ...[glintLive.shot(store), picture, glintLive.warnings(store)].filter(e => e)),
                    element('div', {class: 'side'}, pixel, glintLive.figures(store), glintLive.out(store)))), keys);
        document.title = `glint live: ${glintChart.text(store.registry.captures[0]?.name)}`;
    }

    /* B of a link. */
    async function pinGiven(store, b) {
        if (!b || typeof b !== 'object') return;
        const title = typeof b.title === 'string' ? b.title : undefined;
        if (b.of && b.effect) return store.pinAnswer(b.of, b.effect, title ?? String(b.of));
        try {
            if (b.state) store.pinState((await api.post('/api/v1/pipeline', {state: b.state})).state, title);
        } catch (error) { store.notice(`The link's B cannot be shown here: ${error.message}`); }
    }

    /* Once there is an A. */
    function pinLinked(store) {
        const {b} = glintLive.store.linked(), off = store.on('idle', () => { off(); pinGiven(store, b); });
    }

    /* A link that is opened where the page is: all of it, or nothing and a message. */
    async function openLink(store) {
        const given = glintLive.store.linked();
        if (!given?.state) return;
        try {
            store.setState((await api.post('/api/v1/pipeline', {state: {...store.state, ...given.state}})).state);
        } catch (error) {
            store.notice(`The link's state cannot be shown here: ${error.message}`);
            return;
        }
        store.look = store.lookOf(given.look);
        store.emit('look');
        pinGiven(store, given.b);
    }

    async function start() {
        let registry;
        try {
            registry = await api.get('/api/v1/registry');
        } catch (error) { return fail(error); }
        const store = glintLive.store(registry), linked = store.restore();
        glintLive.runs(store);
        if (linked) store.state = {...store.state, ...linked};
        /* A link to what this server does not have is said, and the page starts from its own start. */
        if (linked) {
            try {
                store.state = (await api.post('/api/v1/pipeline', {state: store.state})).state;
            } catch (error) {
                store.state = {...store.state, use: {}, set: {}, skip: [], force: [], ...registry.start};
                store.lost = error.message;
            }
        }
        build(store);
        if (linked && !store.lost) pinLinked(store);
        if (store.lost) store.notice(`The link's state cannot be shown here: ${store.lost}`);
        addEventListener('hashchange', () => openLink(store));
        listen(store);
        store.request();
        glintLive.shown = store; /* for the console, and for tests */
        document.documentElement.dataset.ready = 'yes';
    }

    /* The address of another server, opened in this tab, loads nothing by itself. */
    addEventListener('hashchange', () => {
        if (api.takeToken() || (api.begin() && document.documentElement.dataset.ready !== 'yes')) location.reload();
    });
    api.onRefused(() => {
        if (document.documentElement.dataset.ready === 'yes') askToken('The server does not know this token any more: it may have been started again.');
    });
    document.documentElement.dataset.look = matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
    if (api.begin()) start(); else api.askTabs().then(known => { if (known) start(); else askToken(''); });
})();
