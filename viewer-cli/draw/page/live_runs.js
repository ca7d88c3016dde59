/* Sends states to the server and keeps what comes back: at most one replay is under way, and the newest change is the next. Where the
   last whole frame took long, a draft comes first. Also what is made beside it: pinned runs, the truth. */
glintLive.runs = (function () {
    'use strict';
    const {api, store: {keyOf, copy}} = glintLive;
    const SLOW_S = 0.3; /* from which on a draft is shown first */
    const REFINE_MS = 400; /* after the last change */

    /* Names of what differs between two states, as in "set": these controls are to blame for a refusal. */
    function differing(a, b) {
        const keys = part => [...new Set([...Object.keys(a[part] || {}), ...Object.keys(b[part] || {})])].filter(k => a[part]?.[k] !== b[part]?.[k]);
        return [...keys('set'), ...keys('use'), ...(a.preset !== b.preset ? ['preset'] : [])];
    }

    return function (store) {
        const {registry} = store;
        let wanted = null, busy = false, refining = null, lastWhole = 0;
        store.running = null; /* null, 'draft' or 'whole' */
        store.accepted = null; /* the last state that the server took */
        store.refusal = null;  /* {names, message} of the last one that it did not take */

        const newest = () => wanted === null;

        function takeStructure(answer) {
            store.slots = answer.slots;
            store.command = answer.command;
            store.emit('slots');
        }

        function take(result) {
            store.result = result;
            store.accepted = result.state;
            if (!result.draft) lastWhole = result.seconds;
            if (newest()) {
                if (store.refusal) { store.refusal = null; store.emit('refused'); }
                if (keyOf(result.state) !== keyOf(store.state)) store.showState(result.state);
                takeStructure(result);
                if (store.error) store.setError(null);
            }
            store.emit('result');
        }

        function fail(error, state) {
            if (error.code === 'superseded') return;
            if (error.status === 400 && newest()) {
                const before = store.accepted;
                store.refusal = {names: before ? differing(before, state) : [], message: error.message};
                if (before) store.dropStep(before);
                store.emit('refused');
                return;
            }
            store.setError(error);
        }

        function setRunning(what) {
            store.running = what;
            if (!what) store.progress = null;
            store.emit('progress');
        }

        const wantsDraft = state => !!registry.captures[state.capture]?.draft && lastWhole > SLOW_S;

        /* A draft where replays are slow, and where they are fast a run that compiles nothing; then the whole frame from its own programs. */
        async function replay(state) {
            const draft = wantsDraft(state), quick = draft || !registry.device.cpu;
            setRunning(draft ? 'draft' : 'whole');
            const first = await run({state, draft, quick, urgent: true});
            take(first);
            if (newest() && (first.draft || first.quick)) await refine(state, first.draft ? 0 : REFINE_MS);
        }

        /* What this compiles cannot be given up, so that a drag has to have ended before. */
        async function refine(state, pause) {
            refining = new AbortController();
            const {signal} = refining;
            try {
                await new Promise(done => { setTimeout(done, pause); signal.addEventListener('abort', done); });
                if (signal.aborted) return;
                setRunning('whole');
                take(await run({state, draft: false, quick: false, urgent: false}, signal));
            } finally {
                refining = null;
            }
        }

        /* What another client's run gave up, or a server with too many requests refused, is asked again, and then waits its turn. */
        async function run(what, signal) {
            const body = {...what, client: api.client};
            try {
                return await api.post('/api/v1/run', body, signal);
            } catch (error) {
                if (!api.later(error) || signal?.aborted || !newest()) throw error;
            }
            return api.insist('/api/v1/run', {...body, urgent: false}, newest, signal);
        }

        async function pump() {
            if (busy) return;
            busy = true;
            while (wanted) {
                const state = wanted;
                wanted = null;
                try {
                    await replay(state);
                } catch (error) {
                    fail(error, state);
                }
            }
            busy = false;
            setRunning(null);
            store.emit('idle');
        }

        /* Whether slots come and go, which the pipeline shows before the replay is done. */
        let structure = null;
        async function look(state) {
            const key = keyOf({...state, set: {}, skip: [], force: []});
            if (key === structure) return;
            structure = key;
            try {
                const answer = await api.post('/api/v1/pipeline', {state});
                if (keyOf(store.state) === keyOf(state)) takeStructure(answer);
            } catch { /* the replay says it, too */ }
        }

        store.request = () => {
            wanted = copy(store.state);
            if (refining) refining.abort();
            look(wanted);
            pump();
        };
        store.busy = () => busy;
        /* What was refused is not in the state; its control shows it until somebody changes it. */
        store.clearRefusal = () => {
            if (!store.refusal) return;
            store.refusal = null;
            store.emit('refused');
        };
        store.on('changed', store.request);

        others(store);
    };

    /* ---- B and the truth ---- */

    function others(store) {
        const {registry} = store;
        let truthOf = null, pins = 0, pinning = 0; /* pins: the last thing that was to be B is, whatever is answered first */

        const titleOf = state => {
            const changes = [...Object.entries(state.use).map(([k, v]) => `${k}: ${v}`), ...Object.entries(state.set).map(([k, v]) => `${k}=${v}`),
                ...state.skip.map(s => `without ${s}`), ...state.force.map(s => `always ${s}`)];
            return [state.preset, ...changes.slice(0, 3), ...(changes.length > 3 ? [`${changes.length - 3} more`] : [])].join(', ');
        };
        store.titleOf = titleOf;

        function setPinned(pinned) {
            pins++;
            store.pinned = pinned;
            store.emit('pinned');
        }
        store.unpin = () => setPinned(null);
        store.pinResult = (title, result) => setPinned({title, result, of: null});

        const isWhole = result => result && !result.draft && !result.quick;

        /* B is a state; the run of it that is there is taken. */
        store.pinState = async (state, title = titleOf(state)) => {
            if (isWhole(store.result) && keyOf(store.result.state) === keyOf(state)) return store.pinResult(title, store.result);
            await pin(wanted => api.insist('/api/v1/run', {state, client: api.client}, wanted), result => store.pinResult(title, result));
        };

        const answer = (of, effect, wanted) => api.insist('/api/v1/answer', {state: store.state, effect, of, client: api.client}, wanted);

        store.pinAnswer = async (of, effect, title) => {
            await pin(wanted => answer(of, effect, wanted), result => {
                const again = store.pinned?.of === of && store.pinned.effect === effect;
                setPinned({title, result, of, effect});
                if (!again) lookAtCompared(result);
            });
        };

        async function pin(make, done) {
            const mine = ++pins, wanted = () => mine === pins;
            pinning++;
            try {
                const result = await make(wanted);
                if (wanted()) done(result);
            } catch (error) {
                if (wanted()) store.notice(error.message);
            } finally { pinning--; }
        }

        /* What the result of an effect should be says nothing beside another image. */
        function lookAtCompared({compares}) {
            const {result} = store, shown = result && glintLive.images.chosen(result, store.look.image)?.name;
            const fits = glintParts.list(compares).find(name => result?.images.some(i => i.name === name));
            if (fits && !compares.includes(shown)) store.setLook({image: fits});
        }

        store.swap = () => {
            const b = store.pinned, a = store.result;
            if (!b || b.of || !isWhole(a)) return;
            setPinned({title: titleOf(a.state), result: a, of: null});
            store.setState(b.result.state);
        };

        /* B follows to another frame. */
        async function follow() {
            const b = store.pinned, capture = store.state.capture;
            if (!b || store.playing || pinning || b.result.state.capture === capture || store.busy() || b.tried === capture) return;
            b.tried = capture; /* there may be no answer for it */
            if (b.of) await store.pinAnswer(b.of, b.effect, b.title);
            else await store.pinState({...b.result.state, capture}, b.title);
        }

        /* Ids of runs say nothing to a server that has been started again. */
        store.on('back', () => {
            const b = store.pinned;
            truthOf = null;
            if (b?.of) store.pinAnswer(b.of, b.effect, b.title);
            else if (b) pin(wanted => api.insist('/api/v1/run', {state: b.result.state, client: api.client}, wanted), result => store.pinResult(b.title, result));
        });

        async function findTruth() {
            const capture = registry.captures[store.state.capture], effect = store.effect;
            const known = effect && capture?.truth?.includes(effect), key = `${store.state.capture} ${effect}`;
            if (truthOf === key || (known && (store.playing || store.busy()))) return;
            truthOf = key;
            store.truth = null;
            try {
                const found = known ? await answer('truth', effect) : null;
                if (truthOf !== key) return;
                store.truth = found && {title: 'truth', result: found};
            } catch { truthOf = null; }
            store.emit('truth');
        }

        store.on('idle', () => { follow(); findTruth(); });
        store.on('effect', findTruth);
    }
})();
