"""What plans leave out, scene by scene: writes docs/plans.md from records that it makes on any device.

plans.py record GLINT --as NAME -o RECORD.json [--size WxH] [--cube N] [--rounds N]
plans.py page
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
RECORDS = ROOT / 'tests' / 'records' / 'plans'
SCENES = {'matte': 'nothing reflects', 'desert_night': 'one mirror, no sky', 'rain_street': 'wet and rough, no mirror',
          'lake': 'water, little else', 'glasshouse': 'panes', 'still_life': 'nothing moves', 'room': 'polished tiles',
          'street': 'almost everything reflects'}


def glint(program, *arguments):
    return subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def times(run):
    """Milliseconds of all passes that ran, of those that a cube map's change alone calls for, and of the survey."""
    device = [p for p in run['passes'] if p['ran'] and not p.get('host')]
    cached = sum(p['time_ns']['median'] for p in device if p.get('cached_work'))
    survey = ((run['survey'] or {}).get('time_ns') or {'median': 0})['median']
    return {'all': (sum(p['time_ns']['median'] for p in device) + survey) / 1e6, 'cubes': cached / 1e6, 'survey': survey / 1e6}


def measure(program, capture, folder, rounds, *options):
    glint(program, 'replay', capture, '-o', folder, '--outputs', 'composed', '--cache=none', '--no-cache', '--repeat', rounds, *options)
    return json.loads((pathlib.Path(folder) / 'run.json').read_text(encoding='utf-8'))


def record(a):
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        for scene in SCENES:
            capture = f'{folder}/{scene}.exr'
            glint(a.glint, 'sample', scene, '-o', capture, '--size', a.size, '--cube-size', a.cube)
            planned, whole = (measure(a.glint, capture, f'{folder}/run', a.rounds, *o) for o in ([], ['--all']))
            survey = planned['survey']
            rows[scene] = {'planned': times(planned), 'whole': times(whole), 'passes': len(planned['passes']),
                           'ran': sum(p['ran'] for p in planned['passes']),
                           'left_out': [p['slot'] for p in planned['passes'] if not p['ran']],
                           'reflecting': survey['reflecting']['count'] / survey['pixels']}
            device = planned['device']
    pathlib.Path(a.output).write_text(json.dumps({'as': a.name, 'device': device['name'], 'size': a.size, 'cube': a.cube,
                                                  'rounds': a.rounds, 'scenes': rows}, indent=1) + '\n', encoding='utf-8')


def table(r):
    lines = ['| scene | pixels that reflect | passes run | planned, ms | survey, ms | `--all`, ms | planned of `--all` | every frame alone |',
             '| --- | --- | --- | --- | --- | --- | --- | --- |']
    for scene, row in r['scenes'].items():
        p, w = row['planned'], row['whole']
        lines.append(f'| `{scene}`: {SCENES[scene]} | {100 * row["reflecting"]:.1f} % | {row["ran"]} of {row["passes"]} | {p["all"]:.1f} | '
                     f'{p["survey"]:.2f} | {w["all"]:.1f} | {100 * p["all"] / w["all"]:.1f} % | '
                     f'{100 * (p["all"] - p["cubes"]) / (w["all"] - w["cubes"]):.1f} % |')
    return lines


def page(_):
    records = [json.loads(f.read_text(encoding='utf-8')) for f in sorted(RECORDS.glob('*.json'))]
    text = ['# What plans leave out', '', 'Written by `tests/plans.py`. Preset `mafia3`; times are medians of the device\'s own timestamps, planned with the survey',
            'included, against `--all`, which uses neither survey nor lists and traces every surface. *Every frame alone* leaves out what is made of',
            'cube maps once (MIP chains, cocoon). Planned and whole pictures are the same, bit for bit (`gpu_planned`).']
    for r in records:
        text += ['', f'## {r["as"]}', '', f'{r["device"]}, {r["size"].replace("x", "×")}, cube maps of {r["cube"]}², {r["rounds"]} rounds.', ''] + table(r)
    text += ['', '## Passes that do not run', '', '| scene | left out |', '| --- | --- |']
    for scene, row in records[0]['scenes'].items():
        text.append(f'| `{scene}` | {", ".join(f"`{s}`" for s in row["left_out"]) or "none"} |')
    (ROOT / 'docs' / 'plans.md').write_text('\n'.join(text) + '\n', encoding='utf-8')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    r = commands.add_parser('record')
    r.add_argument('glint')
    r.add_argument('--as', dest='name', required=True)
    r.add_argument('-o', '--output', required=True)
    r.add_argument('--size', default='480x270')
    r.add_argument('--cube', type=int, default=128)
    r.add_argument('--rounds', type=int, default=3)
    r.set_defaults(run=record)
    commands.add_parser('page').set_defaults(run=page)
    a = parser.parse_args()
    a.run(a)


main()
