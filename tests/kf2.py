#!/usr/bin/env python3
"""What each part of the preset kf2 buys, on and off: kf2.py GLINT MEASURE_TRACES [-o docs/kf2.md]."""
import argparse
import json
import pathlib
import subprocess
import tempfile

SCENES = ('street', 'room', 'hotel')
SIZE, TRUTH = '640x360', '8'
# Name on the page, variant of screen_trace, settings.
TRUST = [
    ('`kf2`', 'hiz', ''),
    ('without `resolve.viewer`, rays towards the viewer traced', 'hiz', 'resolve.viewer=false screen_trace.viewer_limit=1'),
    ('the attenuation kept, without its early-out', 'hiz', 'screen_trace.viewer_limit=1'),
    ('tiles rejected beforehand: `classify=coarse`', 'hiz', 'classify=coarse'),
    ('without `resolve.edge`', 'hiz', 'resolve.edge=false'),
    ('without `resolve.back_face`', 'hiz', 'resolve.back_face=false'),
    ('none of the attenuations', 'hiz', 'resolve.viewer=false screen_trace.viewer_limit=1 resolve.edge=false resolve.back_face=false'),
    ('pyramid, all is solid (the source)', 'hiz', 'screen_trace.thickness_m=1e6'),
    ('the same, without `resolve.back_face`', 'hiz', 'screen_trace.thickness_m=1e6 resolve.back_face=false'),
    ('16 steps and 6 bisections', 'linear_binary', ''),
    ('16 steps alone', 'linear_binary', 'screen_trace.refinements=0'),
    ('the same, no dither', 'linear_binary', 'screen_trace.refinements=0 screen_trace.dither=false'),
    ('every texel', 'dda', ''),
]
COLOUR = [
    ('`kf2`', []),
    ('no blur: `resolve.blur=0`', ['resolve.blur=0']),
    ('half as wide: `resolve.blur=0.5`', ['resolve.blur=0.5']),
    ('twice as wide: `resolve.blur=2`', ['resolve.blur=2']),
    ('5 × 5 taps: `resolve.taps=5`', ['resolve.taps=5']),
    ('at most 6 pixels: `resolve.blur_limit=6`', ['resolve.blur_limit=6']),
]


def trust(program, captures):
    command = ['0', 'kf2']
    for _, variant, settings in TRUST:
        command += [variant, *settings.split(), ',']
    found = {}
    for scene, capture in captures.items():
        lines = subprocess.run([program, str(capture), *command[:-1]], capture_output=True, text=True, check=True).stdout
        found[scene] = [json.loads(line) for line in lines.splitlines()][1:]
    table = ['| | ' + ' | '.join(SCENES) + ' | fetches |', '| --- |' + ' --- |' * (len(SCENES) + 1)]
    for i, (name, _, _) in enumerate(TRUST):
        rows = [found[scene][i] for scene in SCENES]
        cells = [f"{100 * r['hits'] / r['rays']:.1f}, {100 * r['recall']:.1f}, {100 * r['precision']:.1f}" for r in rows]
        table.append(f"| {name} | {' | '.join(cells)} | {sum(r['fetches'] for r in rows) / len(rows):.1f} |")
    return '\n'.join(table)


def surfaces(glint, capture, settings):
    command = [glint, 'replay', str(capture), '--preset', 'kf2', '--json', '--against', 'truth']
    for setting in settings:
        command += ['--set', setting]
    run = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)['runs'][0]
    return {row['surfaces']: row for row in run['against_truth']['image']['surfaces']}


def colour(glint, captures):
    table = ['| | ' + ' | '.join(SCENES) + ' |', '| --- |' + ' --- |' * len(SCENES)]
    for name, settings in COLOUR:
        found = [surfaces(glint, capture, settings) for capture in captures.values()]
        cells = [', '.join(f"{rows[kind]['rmse']:.3f}" for kind in ('mirror-like', 'glossy', 'rough')) for rows in found]
        table.append(f"| {name} | {' | '.join(cells)} |")
    return '\n'.join(table)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('glint')
    parser.add_argument('program')
    parser.add_argument('-o', '--output', default='docs/kf2.md')
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        captures = {scene: pathlib.Path(folder) / f'{scene}.exr' for scene in SCENES}
        for scene, capture in captures.items():
            subprocess.run([arguments.glint, 'sample', scene, '-o', str(capture), '--size', SIZE, '--cube-size', '16', '--truth', TRUTH],
                           check=True, stderr=subprocess.DEVNULL)
        text = pathlib.Path(__file__).with_name('kf2.md.in').read_text()
        text = text.replace('@TRUST@', trust(arguments.program, captures)).replace('@COLOUR@', colour(arguments.glint, captures))
    pathlib.Path(arguments.output).write_text(text)


main()
