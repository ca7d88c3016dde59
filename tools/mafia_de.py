#!/usr/bin/env python3
"""What each part of the preset mafia_de buys, on and off: mafia_de.py GLINT [-o DOCS]."""
import argparse
import json
import pathlib
import tempfile

from pages import Times, compare, errors, options, picture, preset, run, sample, sheet, table

SIZE, CUBE, TRUTH = '320x180', '128', '64'
SCENES = ('street', 'room', 'hotel')
ALONE = 'cubemap_trace.length_m=0.001 cubemap_trace.length_lq_m=0.001 cubemap_trace.exhausted=fallback cubemap_trace.fallback=black'
FOG = ('--set', 'resolve.fog=false')  # the truth has no fog
# Name on the page, changed settings.
COLOUR = [
    ('`mafia_de`', ''),
    ('`downsample.lobe=half_vector`', 'downsample.lobe=half_vector'),
    ("this frame's picture: `resolve=hit`", 'resolve=hit'),
    ('occluded points accepted: `resolve.reject=false`', 'resolve.reject=false'),
    ('occluded points black: `resolve.hidden=black`', 'resolve.hidden=black'),
    ('no sharing: `blur=none`', 'blur=none'),
    ('five samples: `blur=plus`', 'blur=plus'),
    ('`blur.edges=false`', 'blur.edges=false'),
    ('`blur.width=0.25`', 'blur.width=0.25'),
    ('`blur.width=1`', 'blur.width=1'),
    ('edges by shading normals: `downsample.vertex_planes=false`', 'downsample.vertex_planes=false'),
    ('outliers kept: `temporal.outlier=1e6`', 'temporal.outlier=1e6'),
    ('`upscale.lobes=false`', 'upscale.lobes=false'),
    ('`upscale=bilinear`', 'upscale=bilinear'),
    ('without edges: `blur.edges=false`, `upscale=bilinear`', 'blur.edges=false upscale=bilinear'),
    ('cube maps by direction: `cubemap_trace=lookup`', 'cubemap_trace=lookup'),
    ('only the screen: no ray continues in cube maps', ALONE),
    ('only cube maps: `screen_trace.length_m=0`', 'screen_trace.length_m=0'),
    ('16 rays: `mafia_de`', 'pipeline.rays=16'),
    ('16 rays: `blur.edges=false`', 'pipeline.rays=16 blur.edges=false'),
    ('16 rays: `upscale=bilinear`', 'pipeline.rays=16 upscale=bilinear'),
    ('16 rays: without edges', 'pipeline.rays=16 blur.edges=false upscale=bilinear'),
]
# A camera that moves far per frame, so that much is disoccluded.
MOVED, MOVED_SCENES = ('--first-frame', '2', '--travel', '0.5,0,-0.2'), ('street', 'room')
MOVING = [
    ('`mafia_de`', ''),
    ("this frame's picture: `resolve=hit`", 'resolve=hit'),
    ('occluded points accepted: `resolve.reject=false`', 'resolve.reject=false'),
    ('occluded points black: `resolve.hidden=black`', 'resolve.hidden=black'),
]
# Rays at three resolutions: name, settings of mafia_de. The last column of a scene is the cost of tracing.
SPARSE = 'downsample=mips_sparse classify=tiles classify_unfinished=tiles'
TRACED_SCENES = ('street', 'room', 'hotel', 'courtyard')
TRACED = [
    ('every texel of MIP 1: `mafia_de`', ''),
    ('the same at one resolution: `blur=plus`', 'blur=plus'),
    ('MIP 1 and 2: `downsample.mip2_roughness=1`', f'{SPARSE} downsample.mip2_roughness=1'),
    ('MIP 1, 2 and 3: `mafia_de_levels`', SPARSE),
    ('fewer: `downsample.mip1_roughness=0.1`', f'{SPARSE} downsample.mip1_roughness=0.1'),
    ('only MIP 3: `downsample.mip1_roughness=0`, `downsample.mip2_roughness=0`', f'{SPARSE} downsample.mip1_roughness=0 downsample.mip2_roughness=0'),
    ('MIP 1, 2 and 3, 4 rays: `mafia_de_levels`, `pipeline.rays=4`', f'{SPARSE} pipeline.rays=4'),
]
SHOT_SCENES, SHOT_FRAMES = ('street', 'room'), 8
GLASS = [
    ('all', ''),
    ('no screen: `transparent_screen_trace.length_m=0`', 'transparent_screen_trace.length_m=0'),
    ('one cube map: `transparent_cubemap_trace.chain=1`', 'transparent_cubemap_trace.chain=1'),
    ('`transparency.fresnel=false`', 'transparency.fresnel=false'),
    ('no reflection: `transparency.intensity=0`', 'transparency.intensity=0'),
]


def timed():
    return {scene: {words: preset('mafia_de', words) for _, words in rows} for scene, rows in (('street', COLOUR), ('glasshouse', GLASS))}


def colour(glint, captures, scenes, wanted, times):
    rows = [[name, *(errors(glint, capture, 'mafia_de', words, *FOG)[0] for capture in captures), *times.cells('street', words)] for name, words in wanted]
    return table(['settings', *(f'RMSE in {scene}: mirror-like, glossy, rough' for scene in scenes), *(f'{head}, street' for head in times.heads)], rows)


def glass(glint, folder, times):
    capture = sample(glint, 'glasshouse', folder, SIZE, CUBE, '--unjittered')
    found = compare(glint, capture, {words: preset('mafia_de', f'{words} compose.intensity=0') for _, words in GLASS}, 1)[1]
    heads, timed = times.timed_columns('glasshouse', [words for _, words in GLASS])
    rows = [[name, f"{found[words]['over'][0]['symmetric']:.4f}", *timed[words]] for name, words in GLASS]
    return table(['settings', 'error of the panes', *heads], rows)


def judged(glint, captures, words):
    """Of the last frame: RMSE of all reflecting surfaces, and fetches of the tracers per pixel of the picture."""
    report = json.loads(run(glint, 'replay', *captures, '--preset', 'mafia_de', '--json', '--diagnostics', '--against', 'truth', *FOG, *options(words)))
    against = report['runs'][-1]['against_truth']
    error, rays = against['image']['surfaces'][0], against['distances'][0]
    width, height = map(int, SIZE.split('x'))
    return error['rmse'], rays['rays'] * rays['fetches'] * (4 if 'rays=4' in words else 1) / (width * height)


def traced(glint, captures, shots):
    rows = []
    for name, words in TRACED:
        found = [judged(glint, [capture], words) for capture in captures]
        rows.append([name, *(f'{error:.3f}, {fetches:.2f}' for error, fetches in found), *(f'{judged(glint, shot, words)[0]:.3f}' for shot in shots)])
    return table(['traced', *(f'{scene}: RMSE, fetches' for scene in TRACED_SCENES), *(f'{scene}, {SHOT_FRAMES} frames: RMSE' for scene in SHOT_SCENES)], rows)


def replayed(glint, capture, folder, name, words):
    run(glint, 'replay', capture, '--preset', 'mafia_de', '-o', folder / name, '--diagnostics', *FOG, *options(words))
    return folder / name


def levels(glint, capture, folder, docs):
    """The article's own sequence of passes, and the same without edges."""
    aware, blind = (replayed(glint, capture, folder, name, words) for name, words in (('aware', ''), ('blind', 'blur.edges=false upscale=bilinear')))
    picked, blurred = next(aware.glob('*-downsample.exr')), next(aware.glob('*-blur.exr'))
    tiles = [
        ('normals that rays are drawn about', f'{aware}:normal_jittered'), ('edges, level 1', f'{picked}:edge_levels'),
        ('edges, level 3', f'{picked}:edge_levels.level2'), ('reflection, level 1', f'{aware}:reflection_half'),
        ('level 3, blurred along rows', f'{blurred}:reflection_across'), ('and along columns', f'{blurred}:reflection_levels.level2'),
        ('level 2, with what came up', f'{blurred}:reflection_levels.level1'), ('level 1, with what came up', f'{aware}:reflection_blurred'),
        ('full resolution', f'{aware}:reflection'), ('the same, blind to edges', f'{blind}:reflection'),
        ('path traced', f'{capture}:truth.reflection.ggx'), ('composed', f'{aware}:composed')]
    sheet([(text, picture(glint, source, folder / f'level-{i}.png')) for i, (text, source) in enumerate(tiles)], 3, docs / 'mafia_de-levels.jpg')


def previous(glint, capture, folder, docs):
    made = {name: replayed(glint, capture, folder, name, words) for name, words in (('kept', ''), ('taken', 'resolve.reject=false'), ('alone', ALONE))}
    tiles = [
        ('found (blue), outside (green), hidden (yellow)', f"{made['kept']}:previous_source"), ('hidden points taken', f"{made['taken']}:reflection_blurred"),
        ('hidden points refused', f"{made['kept']}:reflection_blurred"), ('the screen alone', f"{made['alone']}:reflection"),
        ('with cube maps', f"{made['kept']}:reflection"), ('path traced', f'{capture}:truth.reflection.ggx')]
    sheet([(text, picture(glint, source, folder / f'previous-{i}.png')) for i, (text, source) in enumerate(tiles)], 3, docs / 'mafia_de-sources.jpg')


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('glint')
    parser.add_argument('-o', '--docs', default='docs', type=pathlib.Path)
    args = parser.parse_args()
    times, text = Times('mafia_de'), pathlib.Path(__file__).with_name('mafia_de.md.in').read_text()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)

        def captures(scenes, *more):
            return [sample(args.glint, scene, folder, SIZE, CUBE, '--truth', TRUTH, *more) for scene in scenes]

        still = captures(SCENES)
        text = text.replace('@COLOUR@\n', colour(args.glint, still, SCENES, COLOUR, times))
        levels(args.glint, still[1], folder, args.docs)
        still += captures(TRACED_SCENES[len(still):])
        shots = []
        for scene in SHOT_SCENES:
            run(args.glint, 'sample', scene, '-o', folder / f'{scene}-shot.exr', '--size', SIZE, '--cube-size', CUBE, '--truth', '16', '--frames', SHOT_FRAMES)
            shots.append(sorted(folder.glob(f'{scene}-shot.0*.exr')))
        text = text.replace('@TRACED@\n', traced(args.glint, still, shots))
        moved = captures(MOVED_SCENES, *MOVED)
        text = text.replace('@MOVING@\n', colour(args.glint, moved, MOVED_SCENES, MOVING, Times()))
        previous(args.glint, moved[1], folder, args.docs)
        text = text.replace('@GLASS@\n', glass(args.glint, folder, times))
    (args.docs / 'mafia_de.md').write_text(text.replace('@TIMES@', times.report()))


if __name__ == '__main__':
    main()
