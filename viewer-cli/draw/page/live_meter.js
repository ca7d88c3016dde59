/* Measures states of the page of glint live: error, ends of rays, fetches and times, of A and of B, and keeps what was measured.
   glintLive.meter(store) has what live_figures.js shows. */
glintLive.meter = (function () {
    'use strict';
    const {list} = glintParts, {api, store: {keyOf, copy}} = glintLive;
    const QUICK_S = 1; /* replays up to this long are measured after each change, unless somebody says otherwise */

    const hasTruth = store => list(store.registry.captures[store.state.capture]?.truth).includes(store.effect);

    /* The effects whose results are among the images of the run. */
    function effectsOf(store) {
        const made = new Set(list(store.result?.images).map(i => i.name));
        return store.registry.effects.filter(e => list(e.results).some(r => made.has(r)));
    }

    /* Whether the time of every pass that a frame runs is known: of those that ran in a run that was given up it is not. */
    const isTimed = result => list(result.passes).every(p => !p.ran || p.host || p.cached_work || Number.isFinite(p.ns));

    function make(store) {
        const cache = new Map(), tried = [];
        let files = 0; /* changes of shaders and presets */
        const {registry} = store;
        const self = {against: 'truth', metric: registry.metric || registry.metrics[0]?.name || null, rounds: registry.rounds || 0, automatic: null,
            figures: null, other: null, running: null, error: null, tried};
        const keyFor = (state, against) => JSON.stringify([keyOf(state), store.effect, against, self.metric]);
        const against = () => self.against !== 'truth' || hasTruth(store) ? self.against : null;

        /* After a run that failed the result is not of the state. */
        const isShown = state => keyOf(state) === keyOf(store.state);

        /* Times once measured are not lost to a measurement without them. */
        async function measure(state, rounds, wanted) {
            const of = against(), key = keyFor(state, of), known = cache.get(key);
            if (known && (known.rounds >= rounds)) return known;
            const metrics = self.metric ? [self.metric] : [], {effect} = store, before = files;
            const answer = await api.insist('/api/v1/figures', {state, effect, against: of, metrics, rounds, client: api.client}, wanted);
            const entry = {...answer, rounds, key, state: copy(state)};
            if (before === files) cache.set(key, entry);
            if (cache.size > 500) cache.delete(cache.keys().next().value);
            return entry;
        }

        /* The error over all pixels, which comes first among the sets of classes. */
        self.total = figures => list(figures?.errors).find(e => e.metric === self.metric && Number.isFinite(e.value)) || null;
        self.timeOf = (figures, result) => Number.isFinite(figures?.frame_ns) ? figures.frame_ns : result && !result.draft && !result.quick && isTimed(result) ? result.frame_ns : null;

        function note(figures, result) {
            const error = self.total(figures)?.value, time = self.timeOf(figures, keyOf(result?.state || {}) === keyOf(figures.state) ? result : null);
            if (!Number.isFinite(error) || !Number.isFinite(time)) return;
            const {key, state} = figures, at = tried.findIndex(t => t.key === key);
            const point = {key, state, error, time, effect: store.effect, against: figures.against, metric: self.metric, capture: state.capture, name: store.titleOf(state)};
            if (at < 0) tried.push(point); else tried[at] = point;
        }

        self.measure = async (rounds, asked) => {
            const {result} = store;
            if (!result || result.draft || !store.effect || (self.running && !asked)) return;
            const state = copy(result.state), mine = self.running = {key: keyFor(state, against())};
            const wanted = () => self.running === mine && isShown(state);
            self.error = null;
            store.setBesides('measuring', true);
            store.emit('figures');
            try {
                const found = await measure(state, rounds, wanted);
                if (!wanted()) return;
                self.figures = found;
                note(found, result);
                store.emit('figures');
                self.other = null;
                if (store.pinned && !store.pinned.of) {
                    self.other = await measure(store.pinned.result.state, rounds, wanted);
                    note(self.other, store.pinned.result);
                }
            } catch (error) {
                if (error.code !== 'superseded') self.error = {message: error.message, key: mine.key};
            } finally {
                if (self.running === mine) self.running = null;
                if (!self.running) store.setBesides('measuring', false);
                store.emit('figures');
                if (!self.running && !isShown(state)) self.follow();
            }
        };
        /* Measuring runs the whole frame, also where the last replay had little to do. */
        let quick = false;
        const isQuick = () => {
            const {result} = store;
            if (result && !result.draft && !result.quick) quick = result.seconds < QUICK_S && (self.timeOf(null, result) ?? Infinity) < 1e9 * QUICK_S;
            return quick;
        };
        /* Never against the reference, whose rays take minutes. */
        self.isAutomatic = () => self.against !== 'reference' && (self.automatic === null ? isQuick() : self.automatic);
        /* Figures are of pipelines as the plan runs them. */
        self.isCurrent = () => !!self.figures && !!store.result && self.figures.key === keyFor(store.result.state, against());
        /* After a whole frame: what is known already costs nothing, the rest is measured where that was asked for. */
        self.follow = () => {
            const {result} = store;
            if (!result || result.draft || store.busy() || store.playing || !isShown(result.state)) return;
            const known = cache.get(keyFor(result.state, against()));
            if (known || self.isAutomatic()) self.measure(0, false);
        };
        /* The error of the state that is shown. */
        self.failed = () => self.error && store.result && self.error.key === keyFor(store.result.state, against()) ? self.error.message : null;
        /* What was measured before was of other programs. */
        store.on('files', () => {
            files++;
            cache.clear();
            tried.length = 0;
            self.figures = self.other = null;
            store.emit('figures');
        });
        self.reset = () => { self.figures = self.other = null; self.follow(); store.emit('figures'); };
        return self;
    }

    return Object.assign(make, {effectsOf, hasTruth});
})();
