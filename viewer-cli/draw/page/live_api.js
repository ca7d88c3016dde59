/* The page of glint live asks its server here: docs/live.md over fetch. The token comes from the address that the command prints. */
const glintLive = {};
glintLive.api = (function () {
    'use strict';
    const KEPT = 'glint token', RETRY_MS = 1500, TABS_MS = 250;
    const TOKEN = /^[0-9A-Za-z_-]{8,256}$/;
    const client = Array.from(crypto.getRandomValues(new Uint8Array(8)), b => b.toString(16).padStart(2, '0')).join('');
    let token = null;
    const refused = []; /* what is to be called when the server does not know the token */

    function recall() {
        try { return sessionStorage.getItem(KEPT); } catch { return null; }
    }

    function setToken(value) {
        token = TOKEN.test(value) ? value : null;
        try { if (token) sessionStorage.setItem(KEPT, token); else sessionStorage.removeItem(KEPT); } catch { /* it lives as long as the page */ }
        return token !== null;
    }

    /* Takes the token out of the address, so that it is in no history and no link. What else the fragment holds stays. Whether it was
       another one than before. */
    function takeToken() {
        const before = token, parts = location.hash.slice(1).split('&').filter(p => p);
        const given = parts.find(p => !p.includes('=') && TOKEN.test(p));
        if (!given) return false;
        setToken(given);
        const rest = parts.filter(p => p !== given).join('&');
        history.replaceState(null, '', location.pathname + location.search + (rest ? `#${rest}` : ''));
        return token !== before;
    }

    function begin() {
        if (!takeToken() && !token) setToken(recall() || '');
        return token !== null;
    }

    /* Tabs of one origin have one server: a tab that was opened by a link gets the token from another one. No other origin hears of it. */
    const tabs = typeof BroadcastChannel === 'function' ? new BroadcastChannel(KEPT) : null;
    tabs?.addEventListener('message', ({data}) => { if (data === 'ask' && token) tabs.postMessage({token}); });

    /* Whether another tab knew a token. */
    function askTabs() {
        return new Promise(done => {
            if (!tabs) return done(false);
            const answer = ({data}) => { if (data?.token && !token && setToken(data.token)) end(); };
            const end = () => { tabs.removeEventListener('message', answer); clearTimeout(timer); done(token !== null); };
            const timer = setTimeout(end, TABS_MS);
            tabs.addEventListener('message', answer);
            tabs.postMessage('ask');
        });
    }

    function failure(message, code, status) {
        return Object.assign(new Error(message), {code, status});
    }

    async function ask(method, path, body, signal) {
        let answer;
        try {
            answer = await fetch(path, {method, signal, cache: 'no-store', credentials: 'omit',
                headers: {Authorization: `Bearer ${token}`, ...(body === undefined ? {} : {'Content-Type': 'application/json'})},
                body: body === undefined ? undefined : JSON.stringify(body)});
        } catch (error) {
            if (error.name === 'AbortError') throw failure('given up', 'superseded', 409);
            throw failure('The server does not answer. If glint live has ended, start it again and open the address that it prints.', 'gone', 0);
        }
        if (answer.ok) return answer;
        const said = await answer.json().catch(() => ({}));
        if (answer.status === 401) refused.forEach(f => f());
        throw failure(said.error || `The server answers ${answer.status} to ${path}`, said.code || 'unknown', answer.status);
    }

    /* What comes after the answer's head can fail, too. */
    async function read(answer, how) {
        const response = await answer;
        try {
            return await response[how]();
        } catch (error) {
            throw error.name === 'AbortError' ? failure('given up', 'superseded', 409)
                : failure('The answer of the server ends too early.', 'gone', 0);
        }
    }

    function get(path) { return read(ask('GET', path), 'json'); }
    function post(path, body, signal) { return read(ask('POST', path, body, signal), 'json'); }
    function bytes(path, signal) { return read(ask('GET', path, undefined, signal), 'arrayBuffer'); }
    function file(path, body) { return read(ask('POST', path, body), 'blob'); }

    function pause(ms) { return new Promise(done => setTimeout(done, ms)); }

    /* Whether the same request can be answered later: another run took the replay away, or there are too many requests at once. */
    const later = error => error.code === 'superseded' || error.code === 'busy';

    /* Asks again as long as the server has to put it off. `wanted`: whether the answer is still of use. */
    async function insist(path, body, wanted = () => true, signal = undefined) {
        for (let wait = 50; ; wait = Math.min(800, 2 * wait)) {
            try {
                return await post(path, body, signal);
            } catch (error) {
                if (!later(error) || signal?.aborted || !wanted()) throw error;
            }
            await pause(wait);
            if (!wanted()) throw failure('given up', 'superseded', 409);
        }
    }

    async function lines(path, f) {
        const reader = (await ask('GET', path)).body.pipeThrough(new TextDecoderStream()).getReader();
        f({event: 'connected'});
        for (let rest = ''; ;) {
            const {value, done} = await reader.read();
            if (done) return;
            const parts = (rest + value).split('\n');
            rest = parts.pop();
            for (const line of parts) if (line.trim()) f(JSON.parse(line));
        }
    }

    /* Calls f for each event, and connects again when the stream ends: {"event": "connected"} and {"event": "gone"} say so. */
    async function stream(path, f) {
        for (;;) {
            try {
                await lines(path, f);
            } catch (error) {
                if (error.status === 401) return;
            }
            f({event: 'gone'});
            await pause(RETRY_MS);
        }
    }

    return {client, begin, takeToken, askTabs, setToken, get, post, bytes, file, insist, later, stream, failure, onRefused: f => refused.push(f)};
})();
