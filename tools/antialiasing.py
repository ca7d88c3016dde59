#!/usr/bin/env python3
"""Measures temporal antialiasing against the mean over the area of each pixel, for passes/NOTES.md: antialiasing.py GLINT [FOLDER].

Jittered frames of the finished picture, as the scenes' cameras move, and still: RMSE of the last frame. With history=0 it is the picture without the filter.
Captures are kept in FOLDER."""
import json
import pathlib
import subprocess
import sys
import tempfile

FRAMES = 16
SAMPLE = ['--size', '320x180', '--cube-size', '16', '--frames', str(FRAMES), '--finished', '16', '--truth', '64', '--truth-of', 'antialiased']
SCENES = ['street', 'room', 'hotel', 'courtyard']
PRESET = {'name': 'taa', 'title': 'Temporal antialiasing of the captured picture', 'source': 'glint', 'slots': {'disocclusion': 'depth', 'taa': 'scene'}, 'set': {}}
ROWS = ['history=0 outlier=1e6', '', 'neighbourhood=minmax', 'neighbourhood=none', 'neighbourhood=none uncovered=1.01', 'uncovered=1.01', 'motion=false', 'vector=own',
        'history_filter=bilinear', 'by_luminance=true', 'clamp_still=true', 'outlier=1e6', 'history=4', 'history=63', 'reconstruction=gaussian']


def run(*words):
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    return json.loads(done.stdout)


def error(glint, preset, frames, row):
    words = [word for setting in row.split() for word in ('--set', f'taa.{setting}')]
    last = run(glint, 'replay', *frames, '--preset', preset, '--against', 'truth', '--effect', 'antialiasing', '--json', *words)['runs'][-1]
    return last['against_truth']['image']['surfaces'][0]['rmse']


def main():
    glint = sys.argv[1]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else temporary)
        preset = pathlib.Path(temporary) / 'taa.json'
        preset.write_text(json.dumps(PRESET))
        columns = {}
        for scene in SCENES:
            for way in ('still', 'moving'):
                path = folder / f'{scene}_{way}.exr'
                frames = [path.with_suffix(f'.{n:04d}.exr') for n in range(1, FRAMES + 1)]
                if not frames[-1].exists():
                    subprocess.run([glint, 'sample', scene, '-o', path, *SAMPLE, *(['--travel', '0,0,0'] if way == 'still' else [])], check=True)
                columns[f'{scene}, {way}'] = frames
        print('| | ' + ' | '.join(columns) + ' |\n| --- |' + ' --- |' * len(columns))
        for row in ROWS:
            print(f'| `{row or "taa/scene"}` | ' + ' | '.join(f'{error(glint, preset, frames, row):.4f}' for frames in columns.values()) + ' |', flush=True)


main()
