#!/usr/bin/env python3
"""What each part of the preset mafia_de buys, on and off: mafia_de.py GLINT [-o docs/mafia_de.md]."""
import argparse
import json
import pathlib
import tempfile

from pages import KINDS, Times, compare, options, preset, run, sample, table

SIZE, CUBE, TRUTH = '320x180', '128', '64'
SCENES = ('street', 'room', 'hotel')
# Name on the page, what is changed.
COLOUR = [
    ('`mafia_de`', ''),
    ('`downsample.lobe=half_vector`', 'downsample.lobe=half_vector'),
    ("this frame's picture: `resolve=hit`", 'resolve=hit'),
    ('hidden points taken: `resolve.reject=false`', 'resolve.reject=false'),
    ('hidden points black: `resolve.hidden=black`', 'resolve.hidden=black'),
    ('no sharing: `blur=none`', 'blur=none'),
    ('five samples: `blur=plus`', 'blur=plus'),
    ('`blur.edges=false`', 'blur.edges=false'),
    ('`blur.width=0.25`', 'blur.width=0.25'),
    ('`blur.width=1`', 'blur.width=1'),
    ('edges by shading normals: `downsample.vertex_planes=false`', 'downsample.vertex_planes=false'),
    ('outliers kept: `temporal.outlier=1e6`', 'temporal.outlier=1e6'),
    ('`upscale=bilinear`', 'upscale=bilinear'),
    ('cube maps by direction: `cubemap_trace=lookup`', 'cubemap_trace=lookup'),
]
GLASS = [
    ('all', ''),
    ('no screen: `transparent_screen_trace.length_m=0`', 'transparent_screen_trace.length_m=0'),
    ('one cube map: `transparent_cubemap_trace.chain=1`', 'transparent_cubemap_trace.chain=1'),
    ('`transparency.fresnel=false`', 'transparency.fresnel=false'),
    ('no reflection: `transparency.intensity=0`', 'transparency.intensity=0'),
]


def timed():
    return {scene: {words: preset('mafia_de', words) for _, words in rows} for scene, rows in (('street', COLOUR), ('glasshouse', GLASS))}


def errors(glint, capture, words):
    told = json.loads(run(glint, 'replay', capture, '--preset', 'mafia_de', '--set', 'resolve.fog=false', '--json', '--against', 'truth', *options(words)))
    found = {row['surfaces']: row['rmse'] for row in told['runs'][0]['against_truth']['image']['surfaces']}
    return ', '.join(f'{found[kind]:.3f}' for kind in KINDS)


def colour(glint, folder, times):
    captures = [sample(glint, scene, folder, SIZE, CUBE, '--truth', TRUTH) for scene in SCENES]
    rows = [[name, *(errors(glint, capture, words) for capture in captures), *times.cells('street', words)] for name, words in COLOUR]
    return table(['', *SCENES, *(f'{head}, street' for head in times.heads)], rows)


def glass(glint, folder, times):
    capture = sample(glint, 'glasshouse', folder, SIZE, CUBE, '--unjittered')
    found = compare(glint, capture, {words: preset('mafia_de', f'{words} compose.intensity=0') for _, words in GLASS}, 1)[1]
    rows = [[name, f"{found[words]['over'][0]['symmetric']:.4f}", *times.cells('glasshouse', words)] for name, words in GLASS]
    return table(['', 'panes', *times.heads], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('glint')
    parser.add_argument('-o', '--output', default='docs/mafia_de.md', type=pathlib.Path)
    arguments = parser.parse_args()
    times = Times('mafia_de')
    with tempfile.TemporaryDirectory() as folder:
        text = pathlib.Path(__file__).with_name('mafia_de.md.in').read_text()
        text = text.replace('@COLOUR@\n', colour(arguments.glint, folder, times))
        text = text.replace('@GLASS@\n', glass(arguments.glint, folder, times))
        text = text.replace('@TIMES@', times.told())
    arguments.output.write_text(text)


if __name__ == '__main__':
    main()
