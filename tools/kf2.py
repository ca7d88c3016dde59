#!/usr/bin/env python3
"""What each part of the preset kf2 buys, on and off: kf2.py GLINT MEASURE_TRACES [-o DOCS]."""
import argparse
import json
import pathlib
import tempfile

from pages import Times, errors, options, picture, preset, run, sample, sheet, table

SCENES = ('street', 'room', 'hotel')
SIZE, CUBE, TRUTH, FINISHED = '640x360', '16', '8', '16'
# Name on the page, changed settings.
TRUST = [
    ('`kf2`', ''),
    ('without `resolve.viewer`, rays towards the viewer traced', 'resolve.viewer=false screen_trace.viewer_limit=1'),
    ('with the attenuation, without its early-out', 'screen_trace.viewer_limit=1'),
    ('tiles rejected beforehand: `classify=coarse`', 'classify=coarse'),
    ('without `resolve.edge`', 'resolve.edge=false'),
    ('without `resolve.back_face`', 'resolve.back_face=false'),
    ('none of the attenuations', 'resolve.viewer=false screen_trace.viewer_limit=1 resolve.edge=false resolve.back_face=false'),
    ('pyramid, everything is solid (the article)', 'screen_trace.thickness_m=1e6'),
    ('the same, without `resolve.back_face`', 'screen_trace.thickness_m=1e6 resolve.back_face=false'),
    ('16 steps and 6 bisections', 'screen_trace=linear_binary'),
    ('16 steps without bisections', 'screen_trace=linear_binary screen_trace.refinements=0'),
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
# With a weapon in front of the camera; with a final image.
FRONT_SCENES, FINISHED_SCENES = ('street', 'room'), ('street', 'room', 'hotel')
FRONT = [
    ('`kf2`', ''),
    ('without `resolve.foreground`', 'resolve.foreground=false'),
    ('everything is solid (the article)', 'screen_trace.thickness_m=1e6'),
    ('the same, without `resolve.foreground`', 'screen_trace.thickness_m=1e6 resolve.foreground=false'),
]
DEFERRED = [
    ('`kf2`: the finished picture', ''),
    ('the diffuse one: `resolve.deferred=false`', 'resolve.deferred=false'),
]
NONE = 'resolve.viewer=false resolve.edge=false resolve.back_face=false resolve.foreground=false'
SOLID = 'screen_trace.thickness_m=1e6 screen_trace.viewer_limit=1'


def timed():
    return {'street': {words: preset('kf2', words) for _, words in TRUST + COLOUR}}


def trust(program, captures, scenes, wanted, times):
    command = ['0', 'kf2']
    for _, words in wanted:
        command += ['hiz', *words.split(), ',']
    found = [[json.loads(line) for line in run(program, capture, *command[:-1]).splitlines()][1:] for capture in captures]
    rows = []
    for (name, words), *report in zip(wanted, *found):
        cells = [f"{100 * r['hits'] / r['rays']:.1f}, {100 * r['recall']:.1f}, {100 * r['precision']:.1f}" for r in report]
        rows.append([name, *cells, f"{sum(r['fetches'] for r in report) / len(report):.1f}", *times.cells('street', words)])
    return table(['settings', *(f'{scene}: coverage, recall, precision, %' for scene in scenes), 'texture fetches per ray', *(f'{head}, street' for head in times.heads)], rows)


def colour(glint, captures, times):
    rows = [[name, *(errors(glint, capture, 'kf2', words)[0] for capture in captures), *times.cells('street', words)] for name, words in COLOUR]
    return table(['settings', *(f'RMSE in {scene}: mirror-like, glossy, rough' for scene in SCENES), *(f'{head}, street' for head in times.heads)], rows)


def deferred(glint, captures):
    rows = [[name, *(cell for capture in captures for cell in errors(glint, capture, 'kf2', words, figures=('symmetric', 'rmse')))]
            for name, words in DEFERRED]
    return table(['settings', *(f'{figure} in {scene}: mirror-like, glossy, rough' for scene in FINISHED_SCENES for figure in ('error', 'RMSE'))], rows)


def replayed(glint, capture, folder, name, words):
    run(glint, 'replay', capture, '--preset', 'kf2', '-o', folder / name, '--diagnostics', *options(words))
    return folder / name


def attenuations(glint, capture, folder, docs):
    """Each by itself, and all together on the source's trace, in which everything is solid."""
    every, none = (replayed(glint, capture, folder, name, f'{SOLID} {words}') for name, words in (('every', ''), ('none', NONE)))
    resolved, white = next(every.glob('*-resolve.exr')), ('--as', 'raw', '--range', '0,1')
    tiles = [(text, picture(glint, f'{resolved}:attenuation:{name}', folder / f'{name}.png', *white)) for text, name in (
        ('towards the viewer', 'viewer'), ("near the picture's border", 'edge'), ('met from behind', 'back_face'), ('on the foreground', 'foreground'))]
    tiles.append(('their product', picture(glint, f'{every}:contribution', folder / 'product.png', *white)))
    tiles.append(('why rays ended (green: hit)', picture(glint, f'{every}:screen_end', folder / 'end.png')))
    tiles += [(text, picture(glint, f'{of}:composed', folder / f'{of.name}.png')) for text, of in (('none of them', none), ('all of them', every))]
    tiles.append(('path traced', picture(glint, f'{capture}:scene', folder / 'truth.png')))
    sheet(tiles, 3, docs / 'kf2-attenuations.jpg')


def lookups(glint, capture, folder, docs):
    tiles, near = [], ('--crop', '320,180,320,180')  # the foot of the column
    for name, words in (('diffuse', 'resolve.deferred=false'), ('finished', '')):
        made = replayed(glint, capture, folder, name, words)
        tiles.append((f'reflection, {name} picture', picture(glint, f'{made}:reflection', folder / f'{name}.png', *near)))
    tiles.append(('path traced', picture(glint, f'{capture}:truth.reflection.ggx', folder / 'lobe.png', *near)))
    sheet(tiles, 3, docs / 'kf2-lookup.jpg')


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('glint')
    parser.add_argument('program')
    parser.add_argument('-o', '--docs', default='docs', type=pathlib.Path)
    args = parser.parse_args()
    times, text = Times('kf2'), pathlib.Path(__file__).with_name('kf2.md.in').read_text()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)

        def captures(scenes, *more):
            return [sample(args.glint, scene, folder, SIZE, CUBE, *more) for scene in scenes]

        plain = captures(SCENES, '--truth', TRUTH)
        text = text.replace('@TRUST@\n', trust(args.program, plain, SCENES, TRUST, times)).replace('@COLOUR@\n', colour(args.glint, plain, times))
        finished = captures(FINISHED_SCENES, '--truth', FINISHED, '--finished', FINISHED)
        text = text.replace('@DEFERRED@\n', deferred(args.glint, finished))
        lookups(args.glint, finished[1], folder, args.docs)
        front = captures(FRONT_SCENES, '--truth', TRUTH, '--finished', FINISHED, '--foreground')
        text = text.replace('@FRONT@\n', trust(args.program, front, FRONT_SCENES, FRONT, Times()))
        attenuations(args.glint, front[0], folder, args.docs)
    (args.docs / 'kf2.md').write_text(text.replace('@TIMES@', times.report()))


if __name__ == '__main__':
    main()
