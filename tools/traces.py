#!/usr/bin/env python3
"""Measures the screen traces against the truth of the sample scenes, and writes docs/traces.md.

traces.py measure GLINT MEASURE_TRACES RECORD.json [--repeat N]   sample, trace, compare; times with --repeat
traces.py page COUNTS.json [TIMES.json] -o docs/traces.md         TIMES: a record of a GPU, for its times alone
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

PRESET = pathlib.Path(__file__).parent / 'traces.json'
SCENES = ('mirror_box', 'street', 'room', 'hotel')
SIZE, LARGE = '960x540', '1920x1080'  # half a million rays; what long rays take
# Name on the page, variant, settings.
TRACES = [
    ('`hiz`', 'hiz', ''),
    ('`dda`', 'dda', ''),
    ('`linear`, Mafia III', 'linear', ''),
    ('`linear`, continues behind objects', 'linear', 'screen_trace.pass_behind=true'),
    ('`linear_binary`, KF2', 'linear_binary', ''),
    ('its linear march without bisections', 'linear_binary', 'screen_trace.refinements=0'),
    ('the same, with as many fetches', 'linear_binary', 'screen_trace.refinements=0 screen_trace.steps=22 screen_trace.step_length=0.0145'),
]
# The same traces with fewer and with more steps.
CELLS = [
    *((f'`hiz`, `cells={n}`', 'hiz', f'screen_trace.cells={n} screen_trace.cells_lq={n}') for n in (8, 16, 32, 64, 96, 128, 256, 512, 4096)),
    *((f'`linear`, `steps={n}`', 'linear', f'screen_trace.steps={n}') for n in (8, 16, 32, 64)),
    *((f'`linear`, `steps={n}`, continues behind objects', 'linear', f'screen_trace.steps={n} screen_trace.pass_behind=true') for n in (16, 32, 64)),
    ('`linear_binary`, KF2', 'linear_binary', ''),
    ('`dda`', 'dda', ''),
]
# Traces that others publish, as measured on the same rays on an NVIDIA H200: µs, recall, precision in %.
PUBLIC = [
    ('a public trace, the fastest', 50, 46, None),
    ('a public trace, on an easy scene', 57, 93, 95),
    ('a public trace, the one that finds most', 439, 97, 88),
]
MECHANISMS = [
    ('`hiz`', 'hiz', ''),
    ('everything is solid (KF2): `thickness_m=1e6`', 'hiz', 'screen_trace.thickness_m=1e6'),
    ('thickness 1 % of the depth, otherwise continues behind: `thickness=0.01 seam=0 solid=0`', 'hiz', 'screen_trace.thickness=0.01 screen_trace.seam=0 screen_trace.solid=0'),
    ('stops behind every object: `pass_behind=false`', 'hiz', 'screen_trace.pass_behind=false'),
    ('infinitely thin objects: `solid=0`', 'hiz', 'screen_trace.solid=0'),
    ('objects twice as deep: `solid=2`', 'hiz', 'screen_trace.solid=2'),
    ('no seams: `seam=0`', 'hiz', 'screen_trace.seam=0'),
    ('seams also between surfaces that do not touch: `jump=1e6`', 'hiz', 'screen_trace.jump=1e6'),
    ('no thickness: `thickness=0`', 'hiz', 'screen_trace.thickness=0'),
    ('ten times the thickness: `thickness=0.01`', 'hiz', 'screen_trace.thickness=0.01'),
    ('no bias: `bias=0`', 'hiz', 'screen_trace.bias=0'),
]


def traces(program, capture, rows, repeat):
    command = [program, str(capture), str(repeat), str(PRESET)]
    for _, variant, settings in rows:
        command += [variant, *settings.split(), ',']
    lines = subprocess.run(command[:-1], capture_output=True, text=True, check=True).stdout.splitlines()
    found = [json.loads(line) for line in lines]
    return {'oracle': found[0], 'rows': {row[0]: answer for row, answer in zip(rows, found[1:])}}


def measure(arguments):
    rows = list(dict.fromkeys(TRACES + MECHANISMS + CELLS))
    record = {'small': {}, 'large': {}}
    with tempfile.TemporaryDirectory() as folder:
        for size, group, scenes, chosen in ((SIZE, 'small', SCENES, rows), (LARGE, 'large', SCENES[1:], TRACES[:2])):
            for scene in scenes:
                capture = pathlib.Path(folder) / f'{scene}.exr'
                subprocess.run([arguments.glint, 'sample', scene, '-o', str(capture), '--size', size, '--cube-size', '16',
                                '--truth', '1'], check=True, stderr=subprocess.DEVNULL)
                record[group][scene] = traces(arguments.program, capture, chosen, arguments.repeat if group == 'small' else 0)
    pathlib.Path(arguments.record).write_text(json.dumps(record, indent=1) + '\n')


def percent(value):
    return f'{100 * value:.1f}'


def quality(record, rows, times):
    timing = ' µs of the trace | µs of the pyramid |' if times else ''
    lines = ['| trace | ' + ' | '.join(f'{s}: recall, precision, %' for s in record['small']) + ' | cells or samples per ray | texture fetches per ray |' + timing, '| --- |' + ' --- |' * (len(SCENES) + (4 if times else 2))]
    lines.append('| oracle | ' + ' | '.join(f"{percent(record['small'][s]['oracle']['recall'])}, 100" for s in SCENES) + ' | none | none |' + (' none | none |' if times else ''))
    for name, variant, _ in rows:
        found = [record['small'][s]['rows'][name] for s in SCENES]
        timed = [times['small'][s]['rows'][name] for s in SCENES] if times else []
        mean = lambda key, of: sum(row[key] for row in of) / len(of)
        pyramid = f"{1000 * mean('pyramid_ms', timed):.0f}" if times and variant == 'hiz' else 'none'
        timing = f" {1000 * mean('trace_ms', timed):.0f} | {pyramid} |" if times else ''
        lines.append(f'| {name} | ' + ' | '.join(f"{percent(r['recall'])}, {percent(r['precision'])}" for r in found)
                     + f" | {mean('steps', found):.1f} | {mean('fetches', found):.1f} |{timing}")
    return '\n'.join(lines)


def over_cells(record, times):
    """Time, recall and precision in one table, by recall: means of the scenes that are not made of mirrors alone."""
    scenes = SCENES[1:]
    mean = lambda of, name, key: sum(of['small'][s]['rows'][name][key] for s in scenes) / len(scenes)
    rows = [(100 * mean(record, name, 'recall'), name, 100 * mean(record, name, 'precision'), 1000 * mean(times, name, 'trace_ms') if times else None,
             1000 * mean(times, name, 'pyramid_ms') if times and variant == 'hiz' else None) for name, variant, _ in CELLS]
    rows += [(recall, name, precision, us, None) for name, us, recall, precision in PUBLIC]
    shown = lambda value, form: '–' if value is None else form.format(value)
    lines = ['| trace | recall, % | precision, % | µs of the trace | and of the pyramid |', '| --- | ---: | ---: | ---: | ---: |']
    return '\n'.join(lines + [f'| {name} | {recall:.1f} | {shown(precision, "{:.1f}")} | {shown(us, "{:.0f}")} | {shown(pyramid, "{:.0f}")} |' for recall, name, precision, us, pyramid in sorted(rows, key=lambda row: row[:2])])


def wrong(record):
    lines = ['| `hiz` in | missed, %: went behind, left the screen, out of steps | wrong, %: truly hidden, truly visible, truly sky | wrong, %: too early, too late |', '| --- | --- | --- | --- |']
    for scene in SCENES:
        r = record['small'][scene]['rows']['`hiz`']
        missed = [percent(r['missed'].get(k, 0)) for k in ('behind', 'left_screen', 'steps_exhausted')]
        lines.append(f"| {scene} | {', '.join(missed)} | {percent(r['wrong_hidden'])}, {percent(r['wrong_shown'])}, {percent(r['wrong_sky'])} | {percent(r['early'])}, {percent(r['late'])} |")
    return '\n'.join(lines)


def long_rays(record):
    lines = ['| rays over 64 pixels at 1920×1080 | `hiz`: cells, fetches | `dda`: texels | fetches of `hiz` / texels of `dda` |', '| --- | --- | --- | --- |']
    for scene, found in record['large'].items():
        h, d = found['rows']['`hiz`'], found['rows']['`dda`']
        lines.append(f"| {scene} | {h['long_steps']:.1f}, {h['long_fetches']:.1f} | {d['long_steps']:.1f} | {h['long_fetches'] / d['long_steps']:.3f} |")
    return '\n'.join(lines)


def distances(record):
    names = [row[0] for row in TRACES[4:]]
    lines = ['| trace | ' + ' | '.join(f'median error of the distance of hits, {s}, %' for s in SCENES) + ' | texture fetches per ray |', '| --- |' + ' --- |' * (len(SCENES) + 1)]
    for name in names:
        found = [record['small'][s]['rows'][name] for s in SCENES]
        lines.append(f'| {name} | ' + ' | '.join(f"{100 * r['median_error']:.2f}" for r in found)
                     + f" | {sum(r['fetches'] for r in found) / len(found):.1f} |")
    return '\n'.join(lines)


def page(arguments):
    record = json.loads(pathlib.Path(arguments.counts).read_text())
    times = json.loads(pathlib.Path(arguments.times).read_text()) if arguments.times else None
    device = f" Times: {times['small'][SCENES[0]]['oracle']['device']}, a trace of half a million rays, median, mean of the scenes." if times else ''
    text = pathlib.Path(__file__).with_name('traces.md.in').read_text()
    for name, table in (('TRACES', quality(record, TRACES, times)), ('MECHANISMS', quality(record, MECHANISMS, times)),
                        ('CELLS', over_cells(record, times)), ('WRONG', wrong(record)), ('LONG', long_rays(record)), ('DISTANCES', distances(record)), ('DEVICE', device)):
        text = text.replace(f'@{name}@', table)
    pathlib.Path(arguments.output).write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    one = commands.add_parser('measure')
    for name in ('glint', 'program', 'record'):
        one.add_argument(name)
    one.add_argument('--repeat', type=int, default=0, help='timed rounds')
    one.set_defaults(run=measure)
    two = commands.add_parser('page')
    two.add_argument('counts')
    two.add_argument('times', nargs='?')
    two.add_argument('-o', '--output', default='docs/traces.md')
    two.set_defaults(run=page)
    arguments = parser.parse_args()
    arguments.run(arguments)


main()
