/* The page of glint live: which image is looked at. Any image of any pass, by slot in order of execution, with a search and MIP levels. */
glintLive.images = (function () {
    'use strict';
    const {element} = glintParts;

    /* MIP levels from 1 on are images of their own: "NAME.level1". */
    const baseOf = image => image.level > 0 ? image.name.replace(new RegExp(`\\.level${image.level}$`), '') : image.name;

    /* [{title, images: [those of level 0]}, …] in the order of the answer. */
    function groupsOf(images, matches) {
        const groups = [];
        for (const image of images) {
            const title = image.slot === null ? 'capture' : image.variant ? `${image.slot}: ${image.variant}` : image.slot;
            if (image.level > 0 || !matches(`${title} ${image.name} ${image.unit} ${image.meaning}`)) continue;
            if (groups.at(-1)?.title !== title) groups.push({title, images: []});
            groups.at(-1).images.push(image);
        }
        return groups;
    }

    /* The image that is shown: the chosen one, or the run's picture if there is none of that name. */
    function chosen(result, name) {
        return result.images.find(i => i.name === name) || result.images.find(i => i.name === result.picture) || result.images[0] || null;
    }

    /* The image of B that A's image is compared with, or null: what an effect should result in stands beside its results only, and the
       picture of a pipeline beside that of another one. */
    function counterpart({result, of}, a, image) {
        if (of && result.compares && !result.compares.includes(image.name)) return null;
        return result.images.find(i => i.name === image.name) || (of || image.name === a.picture ? chosen(result, null) : null);
    }

    function describe(image) {
        const size = image.cube ? `cube map, faces of ${image.width} \u00d7 ${image.width}` : `${image.width} \u00d7 ${image.height}`;
        return [image.meaning, image.unit && image.unit !== '1' ? image.unit : null, image.channels.join(' '), size].filter(t => t).join(' \u00b7 ');
    }

    /* An element in which store.look.image is chosen. */
    function make(store) {
        const search = element('input', {type: 'search', placeholder: 'Search images', 'aria-label': 'search images'});
        const select = element('select', {'aria-label': 'image', change: () => store.setLook({image: select.value})});
        const levels = element('select', {'aria-label': 'MIP level', change: () => store.setLook({image: levels.value})});
        const about = element('p', {class: 'faint'}), none = element('p', {class: 'note', role: 'status'});
        let listed = null;

        function list(result, image) {
            const text = search.value.trim().toLowerCase(), base = baseOf(image);
            const groups = groupsOf(result.images, t => text.split(/\s+/).every(word => t.toLowerCase().includes(word)));
            const options = JSON.stringify(groups.map(g => [g.title, g.images.map(i => i.name)])) + base;
            if (options === listed) return;
            listed = options;
            /* what is shown stays in the list, whatever is searched for */
            const there = groups.some(g => g.images.some(i => i.name === base));
            select.replaceChildren(...(there ? [] : [element('option', {value: base}, base)]), ...groups.map(g => {
                const group = element('optgroup', {label: glintChart.text(g.title)});
                group.append(...g.images.map(i => element('option', {value: i.name, title: glintChart.text(i.meaning)}, i.name)));
                return group;
            }));
            select.value = base;
        }

        function draw() {
            const {result, look} = store;
            e.hidden = !result || !result.images.length;
            if (e.hidden) return;
            const image = chosen(result, look.image), base = baseOf(image), mips = result.images.filter(i => baseOf(i) === base);
            list(result, image);
            select.value = base;
            levels.hidden = mips.length < 2;
            levels.replaceChildren(...mips.map(i => element('option', {value: i.name}, `level ${i.level}`)));
            levels.value = image.name;
            about.textContent = glintChart.text(describe(image));
            none.hidden = !look.image || look.image === image.name;
            none.textContent = glintChart.text(`There is no image ${look.image} in this run; ${image.name} is shown.`);
        }

        search.addEventListener('input', () => { if (store.result) draw(); });
        search.addEventListener('keydown', event => {
            const first = select.querySelector('optgroup option');
            if (event.key !== 'Enter' || !first) return;
            event.preventDefault();
            store.setLook({image: first.value});
        });
        const e = element('div', {class: 'live-images'}, element('div', {class: 'bar'}, search, select, levels), about, none);
        for (const what of ['result', 'look']) store.on(what, draw);
        draw();
        return e;
    }

    return Object.assign(make, {chosen, counterpart});
})();
