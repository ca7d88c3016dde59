#!/usr/bin/env python3
"""Writes the built-in presets as C: presets.py OUT.h NAME.json…"""
import json
import pathlib
import sys

rows = [f'    {{{json.dumps(p.stem)}, {json.dumps(p.read_text())}}},' for p in map(pathlib.Path, sys.argv[2:])]
pathlib.Path(sys.argv[1]).write_text('static const struct builtin_preset builtin_presets[] = {\n' + '\n'.join(rows) + '\n};\n')
