/* The size at which a stage shows its pictures: as wide as there is room, or by whole pixels, under a pointer or a kept pixel that stays in
   place; and moving what does not fit. */
const glintZoom = (function () {
    'use strict';
    const STEPS = ['fit', '1\u00d7', '2\u00d7', '4\u00d7', '8\u00d7', '16\u00d7', '32\u00d7'];
    const WHEEL = 60; /* a notch of a wheel is 100 or 120; a pinch makes many small ones */

    /* `frame` in `scroll`: {size(): [width, height] in pixels, across(): pictures beside each other, resize(zoom), fixed(): [x, y] in the
       frame, 0 to 1, of what stays in place when no pointer says it, or null, changed()}. */
    function create(frame, scroll, own) {
        let zoom = 0, turned = 0;

        /* Pixels of the window for one of the picture, where it fits. There nothing is scrolled, which comes back. */
        function fitScale() {
            const {scrollLeft, scrollTop} = scroll;
            own.resize(0);
            const scale = frame.getBoundingClientRect().width / (own.across() * own.size()[0]);
            own.resize(zoom);
            Object.assign(scroll, {scrollLeft, scrollTop});
            return scale;
        }

        function middle() {
            const at = own.fixed(), box = frame.getBoundingClientRect(), seen = scroll.getBoundingClientRect();
            const x = at ? box.left + at[0] * box.width : NaN, y = at ? box.top + at[1] * box.height : NaN;
            const inside = x >= seen.left && x <= seen.right && y >= seen.top && y <= seen.bottom;
            return inside ? [x, y] : [seen.left + seen.width / 2, seen.top + Math.min(seen.height, innerHeight) / 2];
        }

        /* `at`: the place in the window whose pixel stays there. */
        function set(step, at) {
            const next = Math.min(STEPS.length - 1, Math.max(0, step)), [x, y] = at || middle(), box = frame.getBoundingClientRect();
            const u = (x - box.left) / box.width, v = (y - box.top) / box.height;
            if (next === zoom) return;
            zoom = next;
            own.resize(zoom);
            const now = frame.getBoundingClientRect();
            scroll.scrollLeft += now.left + u * now.width - x;
            scroll.scrollTop += now.top + v * now.height - y;
            own.changed();
        }

        /* The next larger or smaller of all steps, fit among them where its size puts it. */
        function by(way, at) {
            const scales = STEPS.map((_, i) => i ? 2 ** (i - 1) : fitScale()), now = scales[zoom];
            const steps = scales.map((scale, i) => ({scale, i})).filter(s => way * (s.scale - now) > 1e-6).sort((a, b) => way * (a.scale - b.scale));
            if (steps.length) set(steps[0].i, at);
        }

        scroll.addEventListener('wheel', event => {
            if (!event.ctrlKey) return;
            event.preventDefault();
            turned += event.deltaMode ? 100 * Math.sign(event.deltaY) : event.deltaY;
            if (Math.abs(turned) < WHEEL) return;
            by(-Math.sign(turned), [event.clientX, event.clientY]);
            turned = 0;
        }, {passive: false});

        return {
            set, by,
            get zoom() { return zoom; },
            start(step) { zoom = STEPS[step] ? step : 0; },
            move(x, y) { scroll.scrollLeft -= x; scroll.scrollTop -= y; },
            /* Scrolls no further than needed to see a place in the frame. */
            show(u, v) {
                const box = frame.getBoundingClientRect(), seen = scroll.getBoundingClientRect(), margin = 24;
                const x = box.left + u * box.width, y = box.top + v * box.height;
                scroll.scrollLeft += Math.min(0, x - seen.left - margin) + Math.max(0, x - seen.right + margin);
                scroll.scrollTop += Math.min(0, y - seen.top - margin) + Math.max(0, y - seen.bottom + margin);
            },
        };
    }

    return {create, STEPS};
})();
