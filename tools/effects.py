#!/usr/bin/env python3
"""Measures effects beside reflections against their truth, and writes the tables of passes/NOTES.md.

effects.py GLINT [NOTES.md] [CAPTURES] [TABLE…]   GLINT is the program; without NOTES.md, or with -, the tables are printed; captures are kept
                                                  in the folder CAPTURES; TABLE: titles of those to write
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

WIDTH, HEIGHT = 320, 180
SAMPLE = ['--size', f'{WIDTH}x{HEIGHT}', '--cube-size', '16', '--truth', '64']
# Assignments behind a variant's name are its parameters; an assignment to a slot chooses its variant.
TRACE = [
    'length_m=0', 'linear', 'linear steps=8', 'linear steps=64', 'linear thickness=0.005', 'linear thickness=0 thickness_m=0.2',
    'linear thickness=0 thickness_m=1e6', 'linear bias=0.0005', 'linear interpolate=false', 'linear verify=true refine=true',
    'linear back_faces=true', 'linear pass_behind=false', 'linear dither=false', 'linear lift=0.001', 'linear normals=shading',
    'linear downsample=mips contact_apply=planes', 'linear downsample=mips contact_apply=bilinear', 'linear_binary', 'linear_facets',
    'hiz', 'dda', 'dda inside=false', 'dda solid=0.25', 'dda solid=4', 'dda disc=1 directions=16']
MASK = [
    'shadow_mask=captured length_m=0', 'shadow_mask=captured linear', 'length_m=0', 'linear', 'dda', 'length_m=0 offset=0', 'linear offset=0',
    'length_m=0 taps=3', 'linear taps=3', 'linear thickness=0.005', 'linear back_faces=true', 'linear length_m=0.1', 'linear end_fade=0.5',
    'linear border_fade=0.05', 'linear facing=false', 'linear skip=false', 'dda length_m=0.1']
CASCADES = [
    'length_m=0', 'length_m=0 taps=3', 'length_m=0 taps=5', 'length_m=0 taps=5 far_taps=2', 'length_m=0 taps=5 far_taps=5', 'length_m=0 offset=0',
    'length_m=0 shadow_blur=separable', 'length_m=0 shadow_mask.dither=4', 'length_m=0 shadow_mask.dither=4 shadow_blur=separable',
    'length_m=0 shadow_mask.dither=4 shadow_blur=separable shadow_blur.radius=1', 'length_m=0 shadow_mask.dither=4 shadow_blur=separable shadow_blur.radius=4',
    'linear', 'linear taps=5 far_taps=2']
INDIRECT = [
    'linear', 'linear level=1', 'linear indirect_blur=none', 'linear level=0 indirect_blur=none', 'linear indirect_blur.edges=false',
    'linear directions=1', 'linear directions=16', 'hiz', 'linear length_m=0', 'linear fallback=cubemaps', 'linear fallback=cubemaps corrections=0',
    'linear fallback=black', 'linear lookup=surface', 'linear contrast=1', 'linear leaks=false', 'linear screen=current', 'linear normals=shading',
    'hiz level=1 directions=16', 'dda level=0 directions=64 pattern=sobol downsample=none indirect_blur=none indirect_apply=bilinear']
MADE = ['linear', 'linear leaks=false', 'linear volume_make.moved=false', 'linear volume_make.cell_m=2', 'linear fallback=cubemaps']
INDIRECT_SLOTS = {'downsample': 'mips', 'hiz': 'nearest', 'cubemap_active': 'nearest', 'surface_levels': 'picked', 'volume_make': 'gather',
                  'indirect_trace': 'linear', 'indirect_blur': 'edges', 'indirect_apply': 'planes'}
INDIRECT_SAMPLE = ['--cube-size', '128', '--truth', '128', '--truth-of', 'indirect']
OCCLUSION = [
    'radius_m=0', 'horizon', 'horizon ao_blur=none', 'horizon ao_apply=bilinear', 'horizon averaged=ratio', 'horizon behind=solid', 'horizon behind=decay', 'horizon growth=1',
    'horizon normals=vertex', 'horizon downsample=none', 'hemisphere', 'hemisphere ao_blur=none', 'hemisphere normals=vertex', 'horizon slices=16 steps=32 downsample=none ao_blur=none ao_apply=bilinear',
    'dda directions=32 downsample=none ao_blur=none ao_apply=bilinear',
    'dda directions=32 inside=false thickness_m=0.5 downsample=none ao_blur=none ao_apply=bilinear']
EFFECTS = {
    'occlusion': {
        'scenes': ['street', 'room', 'hotel', 'courtyard'], 'sample': ['--truth', '256', '--truth-of', 'occlusion'],
        'slots': {'downsample': 'pick', 'ao_trace': 'horizon', 'ao_blur': 'separable', 'ao_apply': 'planes'},
        'trace': 'ao_trace', 'fetches': 'occlusion_fetches', 'tables': {'ao_trace': (OCCLUSION, [])}},
    'indirect': {
        'scenes': ['street', 'room', 'hotel', 'courtyard'], 'sample': [*INDIRECT_SAMPLE, '--also', 'volume'], 'slots': INDIRECT_SLOTS,
        'trace': 'indirect_trace', 'fetches': 'indirect_fetches', 'levels': 3, 'tables': {'indirect_trace': (INDIRECT, [])}},
    'indirect, no volume': {
        'effect': 'indirect', 'scenes': ['street', 'room', 'hotel', 'courtyard'], 'sample': INDIRECT_SAMPLE, 'slots': INDIRECT_SLOTS,
        'trace': 'indirect_trace', 'fetches': 'indirect_fetches', 'levels': 3, 'tables': {'volume_make': (MADE, [])}},
    'shadow': {
        'scenes': ['courtyard', 'room', 'still_life', 'kitchen'],
        'sample': ['--truth-of', 'sun', '--also', 'shadow'],
        'slots': {'downsample': 'none', 'hiz': 'nearest', 'shadow_mask': 'map', 'contact_trace': 'linear', 'contact_apply': 'bilinear'},
        'trace': 'contact_trace', 'apply': 'contact_apply', 'fetches': 'contact_fetches',
        'tables': {'contact_trace': (TRACE, ['shadow_mask.mask=none']), 'shadow_mask': (MASK, [])}}}
EFFECTS['shadow, cascades'] = {**EFFECTS['shadow'], 'effect': 'shadow', 'optional': ['shadow_blur'], 'tables': {'shadow_blur': (CASCADES, [])},
                               'sample': [*EFFECTS['shadow']['sample'], '--cascades', '4']}
ELSEWHERE = {'facing': 'contact_apply', 'mask': 'shadow_mask', 'taps': 'shadow_mask', 'far_taps': 'shadow_mask', 'offset': 'shadow_mask'}


def run(command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f'{" ".join(map(str, command))}\n{done.stderr}')
    return json.loads(done.stdout) if '--json' in command else None


def arguments(effect, row, settings):
    """The options of a row such as `linear steps=8 downsample=mips`."""
    uses, sets = [], list(settings)
    for word in row.split():
        name, equals, _ = word.partition('=')
        if not equals:
            uses.append(f'{effect["trace"]}={word}')
        elif name in [*effect['slots'], *effect.get('optional', [])]:
            uses.append(word)
        else:
            sets.append(word if '.' in name else f'{ELSEWHERE.get(name, effect["trace"])}.{word}')
    return [part for use in uses for part in ('--use', use)] + [part for a in sets for part in ('--set', a)]


def fetches(glint, effect, out):
    """A texel; of images with levels, a pixel of the picture."""
    names = [effect['fetches'], *(f'{effect["fetches"]}.level{level}' for level in range(1, effect.get('levels', 1)))]
    found = [run([glint, 'view', out, '--image', name, '--stats', '--json'])['channels'][0] for name in names]
    texels = WIDTH * HEIGHT if 'levels' in effect else found[0]['finite']
    return sum(f['mean'] * f['finite'] for f in found) / texels


def measure(glint, name, effect, capture, folder, row, settings):
    name = effect.get('effect', name)
    out = folder / 'run'
    preset = folder / 'preset.json'
    preset.write_text(json.dumps({'name': name, 'title': name, 'source': 'glint', 'slots': effect['slots'], 'set': {}}))
    found = run([glint, 'replay', capture, '-o', out, '--preset', preset, '--diagnostics', '--json', '--against', 'truth', '--effect', name,
                 *arguments(effect, row, settings)])
    image = found['runs'][0]['against_truth']['image']['surfaces'][0]
    return f'{image["rmse"]:.3f}, {image["mean_error"]:+.3f}; {fetches(glint, effect, out):.1f}'


def table(glint, name, effect, captures, folder, rows, settings):
    lines = ['| | ' + ' | '.join(captures) + ' |', '| --- |' + ' --- |' * len(captures)]
    for row in rows:
        lines.append(f'| `{row}` | ' + ' | '.join(measure(glint, name, effect, c, folder, row, settings) for c in captures.values()) + ' |')
        print(lines[-1], file=sys.stderr)
    return '\n'.join(lines)


def main():
    glint, notes, only = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 and sys.argv[2] != '-' else None, sys.argv[4:]
    tables = {}
    with tempfile.TemporaryDirectory() as temporary:
        kept = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else temporary)
        for name, effect in EFFECTS.items():
            if only and not set(only) & set(effect['tables']):
                continue
            captures = {s: kept / f'{name}_{s}.exr' for s in effect['scenes']}
            for scene, path in captures.items():
                if not path.exists():
                    run([glint, 'sample', scene, '-o', path, *SAMPLE, *effect['sample']])
            for title, (rows, settings) in effect['tables'].items():
                if only and title not in only:
                    continue
                tables[title] = table(glint, name, effect, captures, pathlib.Path(temporary), rows, settings)
    if not notes:
        print('\n\n'.join(tables.values()))
        return
    text = pathlib.Path(notes).read_text()
    for title, rows in tables.items():
        text = re.sub(f'(<!-- {title} -->\n).*?(<!-- end -->)', lambda m: m.group(1) + rows + '\n' + m.group(2), text, flags=re.S)
    pathlib.Path(notes).write_text(text)


main()
