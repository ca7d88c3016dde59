/* The page of glint live: pictures from the server. One request of a kind is under way at a time and the newest wish is the next, so that
   a drag shows pictures in between; one for another image is given up at once. */
glintLive.fetch = (function () {
    'use strict';
    const {api} = glintLive;

    /* "format=raw" of docs/live.md: {"head", "pixels": an ImageData}. */
    function decode(buffer) {
        const length = new DataView(buffer).getUint32(0, true);
        const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
        const bytes = new Uint8ClampedArray(buffer, 4 + length, 4 * head.width * head.height);
        return {head, pixels: new ImageData(bytes, head.width, head.height)};
    }

    /* Is not an error: something newer took its place. */
    const givenUp = error => error.code === 'superseded' || error.name === 'AbortError';

    /* done(wish, {head, pixels}) and failed(wish, error) are called for wishes {"path", "what", …} that nothing has made useless. */
    function pictures(done, failed) {
        let wanted = null, flying = null, stop = null, path = null; /* path: of what was answered last */

        async function pump() {
            while (wanted && !flying && wanted.path !== path) {
                const wish = flying = wanted;
                stop = new AbortController();
                try {
                    const picture = decode(await api.bytes(wish.path, stop.signal));
                    if (!wanted || wanted.what !== wish.what) continue;
                    path = wish.path;
                    done(wish, picture);
                } catch (error) {
                    if (wanted !== wish) continue;
                    wanted = null;
                    if (givenUp(error)) continue;
                    if (error.status === 400 || error.status === 404) path = wish.path; /* it would be refused again */
                    failed(wish, error);
                } finally {
                    flying = null;
                }
            }
        }

        /* null: nothing more is wanted, and what was is forgotten. */
        return wish => {
            if (flying && (!wish || wish.what !== flying.what)) stop.abort();
            if (!wish) path = null;
            if (wish && wanted && wish.path === wanted.path) return;
            wanted = wish;
            pump();
        };
    }

    /* ask(…) answers with what post(…) does, or with null if a later call came before it was sent. */
    function newest(post) {
        let waiting = null, busy = false;

        async function pump() {
            busy = true;
            while (waiting) {
                const {words, done} = waiting;
                waiting = null;
                done(await post(...words));
            }
            busy = false;
        }

        return (...words) => new Promise(done => {
            waiting?.done(null);
            waiting = {words, done};
            if (!busy) pump();
        });
    }

    return {pictures, newest, givenUp};
})();
