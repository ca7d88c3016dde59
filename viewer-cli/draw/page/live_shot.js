/* The frames of a shot: a slider over the captures, play, and marks where the camera cuts. glintLive.shot(store) is the element,
   null if there is one capture. */
glintLive.shot = (function () {
    'use strict';
    const {element} = glintParts, LEAST_MS = 40;

    return function (store) {
        const {captures} = store.registry, last = captures.length - 1;
        if (last < 1) return null;
        const seek = k => {
            const to = (k + captures.length) % captures.length;
            if (to === store.state.capture) return;
            store.showState({...store.state, capture: to});
            store.emit('changed');
        };
        const play = element('button', {type: 'button', class: 'play', click: () => setPlaying(!store.playing)});
        const slider = element('input', {type: 'range', min: 0, max: last, step: 1, 'aria-label': 'frame of the shot',
            input: () => { setPlaying(false); seek(+slider.value); }});
        const name = element('span', {class: 'frame-name', 'aria-live': 'polite'});
        const cuts = captures.flatMap((c, i) => {
            if (!c.cut || i === 0) return [];
            const mark = element('i', {class: 'mark cut', title: glintChart.text(`${c.name}: the camera cuts here`)});
            mark.style.setProperty('--at', i / last);
            return [mark];
        });
        const step = (by, text, label) => element('button', {type: 'button', 'aria-label': label, title: label, click: () => store.seek(by)}, text);

        /* The next frame is asked for when this one is there. */
        let asked = 0;
        function next() {
            if (!store.playing) return;
            const wait = Math.max(0, LEAST_MS - (performance.now() - asked));
            setTimeout(() => { if (store.playing) { asked = performance.now(); seek(store.state.capture + 1); } }, wait);
        }
        function setPlaying(on) {
            if (on === store.playing) return;
            store.playing = on;
            update();
            if (on) { if (!store.busy()) next(); } else store.request(); /* the frame at which it stops is shown whole */
        }
        function update() {
            const c = captures[store.state.capture];
            slider.value = store.state.capture;
            slider.setAttribute('aria-valuetext', glintChart.text(c.name));
            name.textContent = glintChart.text(`${c.name} (${store.state.capture + 1} of ${captures.length}${c.cut ? ', cut' : ''})`);
            play.textContent = store.playing ? 'Pause' : 'Play';
        }
        store.on('state', update);
        store.on('result', () => { if (store.result.state.capture === store.state.capture) next(); });
        store.on('error', () => { if (store.error) setPlaying(false); });
        store.seek = by => { setPlaying(false); seek(store.state.capture + by); };
        store.togglePlay = () => setPlaying(!store.playing);
        update();
        return element('section', {class: 'shot', 'aria-label': 'Shot', role: 'group'}, step(-1, '\u2190', 'frame before'), play, step(1, '\u2192', 'next frame'),
            element('span', {class: 'track'}, slider, ...cuts), name);
    };
})();
