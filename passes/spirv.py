#!/usr/bin/env python3
"""Compiles a pass's shader: spirv.py GLSLANG "SPIRV_OPT OPTION…" SHADER.comp NAME OUT.h OUT.d FOLDER…

Functions are inlined and local variables removed here, once, rather than by the driver in each process that uses the pass: lavapipe makes a
pipeline in two thirds of the time. No pass of spirv-opt that touches arithmetic is used (meson.build), so that the bits are those of a user's copy of the
shader, which glint compiles without this step."""
import pathlib
import struct
import subprocess
import sys
import tempfile

A_LINE = 8


def run(*command):
    """Prints what a program says only if it fails: spirv-opt warns about each function that it does not inline."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        sys.exit(done.stdout)


def main(glslang, spirv_opt, shader, name, out, depfile, *folders):
    with tempfile.TemporaryDirectory() as folder:
        plain, inlined, depends = (f'{folder}/{file}' for file in ('plain.spv', 'inlined.spv', 'plain.d'))
        run(glslang, '--quiet', '--target-env', 'vulkan1.3', *(f'-I{path}' for path in folders), '--depfile', depends, '-o', plain, shader)
        run(*spirv_opt.split(), plain, '-o', inlined)
        data = pathlib.Path(inlined).read_bytes()
        pathlib.Path(depfile).write_text(pathlib.Path(depends).read_text().replace(plain, out, 1))
    words = [f'0x{word:08x}' for word, in struct.iter_unpack('=I', data)]
    lines = [','.join(words[at:at + A_LINE]) for at in range(0, len(words), A_LINE)]
    pathlib.Path(out).write_text(f'const uint32_t {name}[] = {{\n' + ',\n'.join(lines) + '\n};\n')


main(*sys.argv[1:])
