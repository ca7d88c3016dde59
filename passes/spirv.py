#!/usr/bin/env python3
"""Compiles a pass's shader: spirv.py GLSLANG "SPIRV_OPT OPTION…" SHADER.comp NAME OUT.h OUT.d FOLDER…

Functions are inlined and local variables removed here, once, rather than by the driver in each process that uses the pass: lavapipe makes a
pipeline in two thirds of the time. No pass of spirv-opt that touches arithmetic is used (meson.build), so that the bits are those of a user's copy of the
shader, which glint compiles without this step.

OUT.h has the shader twice: NAME, and NAME_unprobed, without the code that records probed pixels (shared/probe/record.glsl), whose removal would
cost the driver more than all else of a large shader."""
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


def array(name, data):
    words = [f'0x{word:08x}' for word, in struct.iter_unpack('=I', data)]
    lines = [','.join(words[at:at + A_LINE]) for at in range(0, len(words), A_LINE)]
    return f'const uint32_t {name}[] = {{\n' + ',\n'.join(lines) + '\n};\n'


def main(glslang, spirv_opt, shader, name, out, depfile, *folders):
    with tempfile.TemporaryDirectory() as folder:
        plain, inlined, depends = (f'{folder}/{file}' for file in ('plain.spv', 'inlined.spv', 'plain.d'))

        def compiled(*options):
            run(glslang, '--quiet', '--target-env', 'vulkan1.3', *options, *(f'-I{path}' for path in folders), '--depfile', depends, '-o', plain, shader)
            run(*spirv_opt.split(), plain, '-o', inlined)
            return pathlib.Path(inlined).read_bytes()
        data = compiled()
        depended = pathlib.Path(depends).read_text()
        unprobed = compiled('-DNO_PROBES') if '/probe/record.glsl' in depended else data
        pathlib.Path(depfile).write_text(depended.replace(plain, out, 1))
    pathlib.Path(out).write_text(array(name, data) + (f'#define {name}_unprobed {name}\n' if unprobed == data else array(f'{name}_unprobed', unprobed)))


main(*sys.argv[1:])
