#!/usr/bin/env python3
"""Measures what the sources leave open, on street and room against their truth, and writes the tables of passes/NOTES.md.

notes.py GLINT [NOTES.md]   GLINT is the program; without NOTES.md the tables are printed.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

SCENES = ['street', 'room']
MIRROR = ['downsample.jitter=false', 'resolve.fog=false']
SCREEN = [
    'defaults', 'steps=16', 'steps=64', 'thickness=0.005', 'thickness=0.05', 'thickness_m=1e6', 'verify=false', 'refine=false',
    'interpolate=false', 'back_faces=false', 'pass_behind=true', 'growth=1', 'growth=2', 'bias=0.003', 'dither=false',
    'sky=false', 'viewer_limit=0', 'length_m=0']
CUBEMAP = [
    'defaults', 'mass_step=0', 'mass_step=1', 'mass_step=2', 'mass_step=5', 'mass=radial', 'mass_m=0', 'mass_m=0.3',
    'mass_m=1e6', 'verify=false', 'verify_part=0.005', 'verify_part=0.05', 'bilinear=false', 'clamp_part=0.01',
    'clamp_part=100', 'bias=0', 'bias=0.002', 'bias=0.01', 'secant=false', 'step_back=false', 'random_scale=false',
    'chain=1', 'chain=2', 'exhausted=direction', 'exhausted=fallback', 'fallback=black', 'fallback=lookup', 'cocoon_start=surface', 'solid=0',
    'steps_hq=48 first_step_m=0.3', 'steps_hq=256 first_step_m=0.05 refinements=8']


def measure(glint, capture, settings):
    command = [glint, 'replay', str(capture), '--json', '--against', 'truth']
    # Passes after the traces, or for rough surfaces only, are disabled.
    command += ['--use', 'screen_trace=linear']
    for slot in ('hiz', 'cubemap_mips', 'sky_mips', 'lit_mips', 'blur', 'temporal', 'resolve_sharp', 'temporal_sharp'):
        command += ['--use', f'{slot}=none']
    for s in MIRROR + settings:
        command += ['--set', s]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode:
        sys.exit(run.stderr)
    found = json.loads(run.stdout)
    while 'against_truth' not in found:  # the report of one capture, or a list
        found = found[0] if isinstance(found, list) else next(v for v in found.values() if isinstance(v, (list, dict)))
    return found['against_truth']['rays']


def cells(rows, tracer):
    row = {(r['tracer'], r['reason']): r for r in rows}
    hits, everything = row.get((tracer, 'hit')), row['all', 'all']
    part = f"{100 * hits['share']:.1f} % / {100 * hits['right']:.1f} %" if hits else '–'
    return f"{part} | {100 * everything['right']:.1f} % | {everything['radiance_error']:.4f}"


def table(glint, captures, slot, tracer, variations, also):
    lines = [f'| {slot} | ' + ' | '.join(f'{s}: hits / right | all right | radiance' for s in SCENES) + ' |',
             '| --- |' + ' --- | --- | --- |' * len(SCENES)]
    for v in variations:
        settings = also + ([f'{slot}.{a}' for a in v.split()] if v != 'defaults' else [])
        lines.append(f'| {v} | ' + ' | '.join(cells(measure(glint, captures[s], settings), tracer) for s in SCENES) + ' |')
    return '\n'.join(lines)


def main():
    glint = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        captures = {s: pathlib.Path(folder) / f'{s}.exr' for s in SCENES}
        for s in SCENES:
            subprocess.run([glint, 'sample', s, '-o', str(captures[s]), '--size', '640x360', '--cube-size', '256', '--truth', '8'],
                           check=True, stderr=subprocess.DEVNULL)
        tables = {
            'screen_trace': table(glint, captures, 'screen_trace', 'screen', SCREEN, []),
            'cubemap_trace': table(glint, captures, 'cubemap_trace', 'cube map', CUBEMAP, ['screen_trace.length_m=0']),
            'together': table(glint, captures, 'cubemap_trace', 'cube map', CUBEMAP[:1] + ['cocoon_start=surface', 'solid=0', 'fallback=lookup', 'fallback=black', 'exhausted=direction', 'exhausted=fallback'], [])}
    if len(sys.argv) < 3:
        print('\n\n'.join(tables.values()))
        return
    notes = pathlib.Path(sys.argv[2])
    text = notes.read_text()
    for name, rows in tables.items():
        text = re.sub(f'(<!-- {name} -->\n).*?(<!-- end -->)', lambda m: m.group(1) + rows + '\n' + m.group(2), text, flags=re.S)
    notes.write_text(text)


main()
