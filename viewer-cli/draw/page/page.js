/* Builds a page of page.h from its document. */
(function () {
    'use strict';
    const {list, element, terms} = glintParts;
    const page = JSON.parse(document.getElementById('document').textContent);
    const data = /^data:image\/(png|jpeg);base64,[A-Za-z0-9+\/=]*$/, beside = /^pictures\/[\w-]+\.png$/;
    const own = glintParts.page(picture => {
        if (picture.beside === true && typeof picture.file === 'string') return beside.test(picture.file) ? picture.file : null;
        const uri = list(page.files)[picture.file];
        return typeof uri === 'string' && data.test(uri) ? uri : null;
    });
    let folds = 0;

    function picturesElement(block) {
        const known = list(block.pictures).filter(own.sourceOf);
        const e = element('div', {class: block.columns === 1 ? 'pictures alone' : 'pictures'}, ...glintParts.figures(known, own).flatMap((figure, i) =>
            known[i].group && known[i].group !== known[i - 1]?.group ? [element('h3', null, known[i].group), figure] : [figure]));
        const least = block.columns > 0 ? `max(${Math.floor(96 / block.columns) - 2}%, 200px)` : '360px';
        e.style.gridTemplateColumns = `repeat(auto-fill, minmax(min(${least}, 100%), 1fr))`;
        return e;
    }

    const blocks = {
        text: b => element('p', null, b.text),
        heading: b => element('h3', null, b.heading),
        note: b => element('p', {class: 'note'}, b.note),
        code: b => element('pre', {tabindex: 0}, b.code),
        table: b => glintParts.tableElement(b.table),
        pictures: picturesElement,
        stage: b => glintStage.stage(b.stage, own),
        chart: b => glintParts.chartElement(b.chart, own),
        fold: b => foldElement(b.fold),
        player: b => glintParts.playerElement(b.player, own),
    };

    /* What is in it is built when it is opened, so that it costs nothing before, and charts have a width. */
    function foldElement(fold) {
        const e = element('details', {class: 'fold'}, element('summary', null, fold.title)), kept = `${page.title}|fold ${folds++}`;
        e.open = page.refresh > 0 && glintStage.recall(kept).open === true;
        e.addEventListener('toggle', () => {
            if (page.refresh > 0) glintStage.store(kept, {open: e.open});
            if (!e.open || e.children.length > 1) return;
            const before = own.charts.length;
            e.append(...list(fold.blocks).map(blockElement).filter(b => b));
            own.charts.slice(before).forEach(c => c.draw());
        });
        return e;
    }

    /* A block that cannot be shown says so, and the others stay. */
    function blockElement(block) {
        const kind = Object.keys(blocks).find(k => block && block[k] !== undefined);
        try {
            return kind ? blocks[kind](block) : null;
        } catch (error) {
            return element('p', {class: 'note'}, `a ${kind} cannot be shown: ${error.message}`);
        }
    }

    const look = glintParts.look(own);
    document.title = glintChart.text(page.title);
    const parts = list(page.sections).filter(s => s && typeof s === 'object');
    const sections = parts.map((s, i) => element('section', {id: `s${i}`}, s.title ? element('h2', null, s.title) : null,
        ...list(s.blocks).map(blockElement)));
    document.body.replaceChildren(
        element('header', null, look.button, element('h1', null, page.title), terms(list(page.facts), null),
            sections.length > 2 ? element('nav', {'aria-label': 'sections'}, ...parts.map((s, i) => s.title ? element('a', {href: `#s${i}`}, s.title) : null)) : null),
        element('main', null, ...sections));
    look.start();
    if (page.refresh > 0) glintStage.refresh(page.refresh);
    document.documentElement.dataset.ready = 'yes';
})();
