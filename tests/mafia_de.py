#!/usr/bin/env python3
"""What each part of the preset mafia_de buys, on and off: mafia_de.py GLINT [-o docs/mafia_de.md]."""
import argparse
import json
import pathlib
import subprocess
import tempfile

SCENES = ('street', 'room', 'hotel')
# Name on the page, options of replay.
COLOUR = [
    ('`mafia_de`', []),
    ('`downsample.lobe=half_vector`', ['--set', 'downsample.lobe=half_vector']),
    ("this frame's picture: `resolve=hit`", ['--use', 'resolve=hit']),
    ('hidden points taken: `resolve.reject=false`', ['--set', 'resolve.reject=false']),
    ('hidden points black: `resolve.hidden=black`', ['--set', 'resolve.hidden=black']),
    ('no sharing: `blur=none`', ['--use', 'blur=none']),
    ('five samples: `blur=plus`', ['--use', 'blur=plus']),
    ('`blur.edges=false`', ['--set', 'blur.edges=false']),
    ('`blur.width=0.25`', ['--set', 'blur.width=0.25']),
    ('`blur.width=1`', ['--set', 'blur.width=1']),
    ('edges by shading normals: `downsample.vertex_planes=false`', ['--set', 'downsample.vertex_planes=false']),
    ('outliers kept: `temporal.outlier=1e6`', ['--set', 'temporal.outlier=1e6']),
    ('`upscale=bilinear`', ['--use', 'upscale=bilinear']),
    ('cube maps by direction: `cubemap_trace=lookup`', ['--use', 'cubemap_trace=lookup']),
]
GLASS = [
    ('all', ''),
    ('no screen: `transparency.length_m=0`', 'transparency.length_m=0'),
    ('cube map by direction: `transparency.cubemap_steps=0`', 'transparency.cubemap_steps=0'),
    ('`transparency.fresnel=false`', 'transparency.fresnel=false'),
    ('no reflection: `transparency.intensity=0`', 'transparency.intensity=0'),
]


def replay(glint, capture, *options):
    command = [glint, 'replay', str(capture), '--preset', 'mafia_de', '--set', 'resolve.fog=false', '--json', *options]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)['runs'][0]


def colour(glint, captures):
    table = ['| | ' + ' | '.join(SCENES) + ' |', '| --- |' + ' --- |' * len(SCENES)]
    for name, options in COLOUR:
        cells = []
        for capture in captures.values():
            rows = replay(glint, capture, '--against', 'truth', *options)['against_truth']['image']['surfaces']
            found = {row['surfaces']: row['rmse'] for row in rows}
            cells.append(', '.join(f'{found[kind]:.3f}' for kind in ('mirror-like', 'glossy', 'rough')))
        table.append(f"| {name} | {' | '.join(cells)} |")
    return '\n'.join(table)


def glass(glint, capture):
    table = ['| | panes |', '| --- | --- |']
    for name, setting in GLASS:
        command = [glint, 'compare', str(capture), '--presets', 'mafia_de', '--repeat', '1', '--json', '--set', 'mafia_de:compose.intensity=0']
        command += ['--set', f'mafia_de:{setting}'] if setting else []
        found = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
        over = found['captures'][0]['presets'][0]['over'][0]
        table.append(f"| {name} | {over['symmetric']:.4f} |")
    return '\n'.join(table)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('glint')
    parser.add_argument('-o', '--output', default='docs/mafia_de.md')
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        captures = {scene: folder / f'{scene}.exr' for scene in (*SCENES, 'glasshouse')}
        for scene, capture in captures.items():
            truth = ['--truth', '64'] if scene in SCENES else ['--unjittered']
            subprocess.run([arguments.glint, 'sample', scene, '-o', str(capture), '--size', '320x180', '--cube-size', '128', *truth],
                           check=True, stderr=subprocess.DEVNULL)
        panes = captures.pop('glasshouse')
        text = pathlib.Path(__file__).with_name('mafia_de.md.in').read_text()
        text = text.replace('@COLOUR@', colour(arguments.glint, captures))
        text = text.replace('@GLASS@', glass(arguments.glint, panes))
    pathlib.Path(arguments.output).write_text(text)


main()
