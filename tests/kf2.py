#!/usr/bin/env python3
"""What each part of the preset kf2 buys, on and off: kf2.py GLINT MEASURE_TRACES [-o docs/kf2.md]."""
import argparse
import json
import pathlib
import tempfile

from pages import KINDS, Times, options, preset, run, sample, table

SCENES = ('street', 'room', 'hotel')
SIZE, CUBE, TRUTH = '640x360', '16', '8'
# Name on the page, what is changed.
TRUST = [
    ('`kf2`', ''),
    ('without `resolve.viewer`, rays towards the viewer traced', 'resolve.viewer=false screen_trace.viewer_limit=1'),
    ('the attenuation kept, without its early-out', 'screen_trace.viewer_limit=1'),
    ('tiles rejected beforehand: `classify=coarse`', 'classify=coarse'),
    ('without `resolve.edge`', 'resolve.edge=false'),
    ('without `resolve.back_face`', 'resolve.back_face=false'),
    ('none of the attenuations', 'resolve.viewer=false screen_trace.viewer_limit=1 resolve.edge=false resolve.back_face=false'),
    ('pyramid, all is solid (the source)', 'screen_trace.thickness_m=1e6'),
    ('the same, without `resolve.back_face`', 'screen_trace.thickness_m=1e6 resolve.back_face=false'),
    ('16 steps and 6 bisections', 'screen_trace=linear_binary'),
    ('16 steps alone', 'screen_trace=linear_binary screen_trace.refinements=0'),
    ('the same, no dither', 'screen_trace=linear_binary screen_trace.refinements=0 screen_trace.dither=false'),
    ('every texel', 'screen_trace=dda'),
]
COLOUR = [
    ('`kf2`', ''),
    ('no blur: `resolve.blur=0`', 'resolve.blur=0'),
    ('half as wide: `resolve.blur=0.5`', 'resolve.blur=0.5'),
    ('twice as wide: `resolve.blur=2`', 'resolve.blur=2'),
    ('5 × 5 taps: `resolve.taps=5`', 'resolve.taps=5'),
    ('at most 6 pixels: `resolve.blur_limit=6`', 'resolve.blur_limit=6'),
]


def timed():
    return {'street': {words: preset('kf2', words) for _, words in TRUST + COLOUR}}


def trust(program, captures, times):
    command = ['0', 'kf2']
    for _, words in TRUST:
        command += ['hiz', *words.split(), ',']
    found = [[json.loads(line) for line in run(program, capture, *command[:-1]).splitlines()][1:] for capture in captures]
    rows = []
    for (name, words), *told in zip(TRUST, *found):
        cells = [f"{100 * r['hits'] / r['rays']:.1f}, {100 * r['recall']:.1f}, {100 * r['precision']:.1f}" for r in told]
        rows.append([name, *cells, f"{sum(r['fetches'] for r in told) / len(told):.1f}", *times.cells('street', words)])
    return table(['', *SCENES, 'fetches', *(f'{head}, street' for head in times.heads)], rows)


def errors(glint, capture, words):
    told = json.loads(run(glint, 'replay', capture, '--preset', 'kf2', '--json', '--against', 'truth', *options(words)))
    found = {row['surfaces']: row['rmse'] for row in told['runs'][0]['against_truth']['image']['surfaces']}
    return ', '.join(f'{found[kind]:.3f}' for kind in KINDS)


def colour(glint, captures, times):
    rows = [[name, *(errors(glint, capture, words) for capture in captures), *times.cells('street', words)] for name, words in COLOUR]
    return table(['', *SCENES, *(f'{head}, street' for head in times.heads)], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('glint')
    parser.add_argument('program')
    parser.add_argument('-o', '--output', default='docs/kf2.md', type=pathlib.Path)
    arguments = parser.parse_args()
    times = Times('kf2')
    with tempfile.TemporaryDirectory() as folder:
        captures = [sample(arguments.glint, scene, folder, SIZE, CUBE, '--truth', TRUTH) for scene in SCENES]
        text = pathlib.Path(__file__).with_name('kf2.md.in').read_text()
        text = text.replace('@TRUST@\n', trust(arguments.program, captures, times)).replace('@COLOUR@\n', colour(arguments.glint, captures, times))
        text = text.replace('@TIMES@', times.told())
    arguments.output.write_text(text)


if __name__ == '__main__':
    main()
