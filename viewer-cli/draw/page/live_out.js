/* What leaves the page: a preset file, the command line, a report of A and B, a run folder, a link. glintLive.out(store) is the element. */
glintLive.out = (function () {
    'use strict';
    const {element} = glintParts, {api} = glintLive;

    function download(blob, name) {
        const url = URL.createObjectURL(blob), link = element('a', {href: url, download: name});
        document.body.append(link);
        link.click();
        link.remove();
        setTimeout(() => URL.revokeObjectURL(url), 10000);
    }

    /* Without the right to the clipboard the text is selected, for Ctrl+C. */
    async function toClipboard(text, shown) {
        try {
            await navigator.clipboard.writeText(text);
            return 'Copied.';
        } catch {
            const range = document.createRange();
            range.selectNodeContents(shown);
            getSelection().removeAllRanges();
            getSelection().addRange(range);
            return 'Selected: press Ctrl+C to copy it.';
        }
    }

    return function (store) {
        const said = element('p', {class: 'faint', role: 'status'});
        const say = text => {
            said.textContent = glintChart.text(text);
            said.scrollIntoView({block: 'nearest'});
        };
        const busy = new Set();
        /* One at a time of each; what it comes to stands below the buttons. */
        const button = (label, title, work, id) => {
            const b = element('button', {type: 'button', id, title, click: async () => {
                if (busy.has(b)) return;
                busy.add(b);
                say('\u2026');
                try { say(await work()); } catch (error) { say(error.message); } finally { busy.delete(b); }
            }}, label);
            return b;
        };
        const command = element('pre', {class: 'command', tabindex: 0, 'aria-label': 'command line that gives the same run'});
        const name = element('input', {type: 'text', 'aria-label': 'name of the preset or of the run folder', value: 'mine',
            spellcheck: 'false', autocomplete: 'off'});
        const link = element('pre', {class: 'command link', tabindex: 0, 'aria-label': 'link to this state', hidden: ''});

        async function savePreset() {
            const answer = await api.insist('/api/v1/preset', {state: store.state, name: name.value});
            const file = `${(answer.name || 'preset').replace(/[^\w.-]/g, '_')}.json`;
            download(new Blob([answer.preset], {type: 'application/json'}), file);
            return `${file} is among the downloads of the browser; use it with --preset ${file}.`;
        }
        async function saveReport() {
            if (!store.pinned || store.pinned.of) throw new Error('Pin a state as B first: the report compares A with B.');
            say('Measuring A and B \u2026');
            download(await api.file('/api/v1/report', {a: store.state, b: store.pinned.result.state}), 'report.html');
            return 'report.html is among the downloads of the browser.';
        }
        async function write() {
            const answer = await api.insist('/api/v1/write', {state: store.state, name: name.value});
            return `Written: ${answer.folder}`;
        }
        const report = button('Report of A and B', 'the page of glint report, as a file', saveReport, 'save-report');
        /* That of the state that the controls show, whose replay may still be under way. */
        async function copyCommand() {
            const answer = await api.post('/api/v1/pipeline', {state: store.state});
            command.textContent = glintChart.text(answer.command);
            return toClipboard(answer.command, command);
        }
        store.copyCommand = () => copyCommand().then(say, error => say(error.message));

        function update() {
            command.textContent = glintChart.text(store.command);
            report.disabled = !store.pinned || !!store.pinned.of;
            link.hidden = true;
        }
        for (const on of ['slots', 'state', 'pinned']) store.on(on, update);
        update();
        return element('section', {class: 'panel out', id: 'out', 'aria-label': 'Out', tabindex: -1}, element('h2', null, 'Out'), command,
            element('div', {class: 'tools'},
                button('Copy command', 'the command line that gives the same run (c)', copyCommand, 'copy-command'),
                button('Copy link', 'a link to this state and look, without the token', () => {
                    link.hidden = false;
                    link.textContent = store.link();
                    return toClipboard(store.link(), link);
                }, 'copy-link'), report),
            element('div', {class: 'tools'}, element('label', null, 'Name ', name),
                button('Save preset', 'a preset file with these variants and parameters', savePreset, 'save-preset'),
                store.registry.out ? button('Write run folder', 'a folder as glint replay -o writes it', write, 'write-run') : null), link, said);
    };
})();
