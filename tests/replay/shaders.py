"""Users' shaders that loop for ever, reach outside of what they are given, or never finish compiling: none takes the process or other images.

shaders.py GLINT LAYER_FOLDER [all]
"""
import filecmp
import os
import shutil
import subprocess
import sys
import tempfile

TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.append(os.path.join(TESTS, "viewer-cli"))
import tap  # noqa: E402
from live import Live, Refused  # noqa: E402

PASSES = os.path.join(os.path.dirname(TESTS), "passes")
START = """#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/bindings.glsl"
#include "hit.pass.h"
#include "shared/push_begin.glsl"
#include "hit.pass.h"
};
"""
STORE = "if (all(lessThan(ivec2(gl_GlobalInvocationID.xy), imageSize(reflection_half)))) imageStore(reflection_half, ivec2(gl_GlobalInvocationID.xy), vec4(sum));"
# lavapipe ends the loops of an invocation after 65,536 turns: each of these takes long, and all together many minutes.
ENDLESS = START + "#define FETCH sum = 0.5 * sum + texelFetch(lit, ivec2(i % 8u, 0), 0).x; i = i * 1664525u + 1013904223u;\n" + \
    "#define FETCHES FETCH FETCH FETCH FETCH FETCH FETCH FETCH FETCH\n" + \
    "void main() { float sum = 0.0; uint i = 0u; while (i != 7u || sum < 1e30) { " + 32 * "FETCHES " + "} " + STORE + " }\n"
# Writes and reads far outside of arrays, shared memory, images, the frame and the records of probed pixels; what it stores in its image does not depend on them.
OUTSIDE = START + """
layout(set = 1, binding = 3) buffer Records { uint words[]; } records;
shared float board[64];
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    int far = int(frame.size.x) * 100000 + pixel.x * 7919;
    float sum = 0.25, own[4] = float[4](0.0, 1.0, 2.0, 3.0);
    for (int sign = -1; sign < 2; sign += 2) {
        int at = sign * far;
        own[at] = board[at] = 3.0;
        records.words[at] = 7u;
        imageStore(reflection_half, pixel + ivec2(at, 0), vec4(own[at / 3]));
        imageStore(reflection_half, pixel + ivec2(0, at), vec4(board[at / 3]));
        imageStore(reflection_half, ivec2(at, -at), texelFetch(lit, pixel + ivec2(at, at), at));
        imageStore(reflection_half, ivec2(at, at), vec4(frame.lamp_place[at]));
    }
    """ + STORE + "\n}\n"
INSIDE = START + "void main() { float sum = 0.25; " + STORE + " }\n"


def expanding(text, times, levels):
    """A macro that expands to `times` to the power of `levels` times the text."""
    return f"#define A0 {text}\n" + "".join(f"#define A{i + 1} " + times * f"A{i} " + "\n" for i in range(levels))


def body(text):
    return f"void main() {{ float sum = 0.0; {text} {STORE} }}\n"


LONG_WORDS = " ".join(f"a_long_identifier_that_fills_memory_{i}" for i in range(400))
# What each shader is, and what the message says; all name the file and exit with status 1 … 5.
REFUSED = {
    "memory": (START + expanding(LONG_WORDS, 100, 5) + body("A5"), "needs more than 256 MiB of memory, the limit"),
    "nested": (START + body("sum = " + 200000 * "(" + "1.0" + 200000 * ")" + ";"), "memory exhausted"),
    "array": (START + body("float a[500000000]; a[int(sum)] = 1.0; sum += a[int(sum) + 5];"), "more than 65536, the limit"),
    "doubles": (START + body("sum = float(double(sum) * 2.0LF);"), "the capability 10 of SPIR-V"),
    "kind": (START + "layout(set = 1, binding = 0) buffer B { uint words[]; } b;\n" + body("b.words[1 << 28] = 3u;"), "binding 0 of set 1"),
    "cycle": (START + '#include "other.glsl"\n' + body(""), "other.glsl includes itself"),
}


class Shaders:
    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="glint-shaders-")
        self.capture = self.path("tiny.exr")
        tap.glint("sample", "street", "--light=1", "-o", self.capture, "--size", "32x18", "--cube-size", "8")

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def replay(self, slot, text, out, *words, preset=tap.PLAIN, **environment):
        file = self.write(out + ".comp", text)
        return subprocess.run([sys.argv[1], "replay", self.capture, "--preset", preset, "-o", self.path(out), "--shader", f"{slot}={file}", *words], capture_output=True, text=True,
                              env={**os.environ, **environment}, timeout=600)

    def refused(self, run, out, *said):
        """With a message, and without a file."""
        assert run.returncode in (1, 2, 3, 4, 5), (run.returncode, run.stderr)
        assert all(text in run.stderr for text in said), (said, run.stderr)
        assert not os.path.exists(self.path(out)), os.listdir(self.path(out))

    def same(self, one, other):
        names = sorted(n for n in os.listdir(self.path(one)) if n.endswith(".exr"))
        _, differ, broken = filecmp.cmpfiles(self.path(one), self.path(other), names, shallow=False)
        assert len(names) > 5 and not differ and not broken, (names, differ, broken)

    def test_a_loop_without_end_is_given_up(self):
        """Of the passes only this one runs: the driver compiles when a pass first runs, which may take longer than a short limit."""
        tiny, self.capture = self.capture, self.path("larger.exr")
        tap.glint("sample", "street", "--light=1", "-o", self.capture, "--size", "256x144", "--cube-size", "8")
        run = self.replay("resolve", INSIDE, "before")
        assert run.returncode == 0, run.stderr
        words = ["--all", "--passes", "resolve", "--inputs", self.path("before"), "--dispatch-limit", "2"]
        self.refused(self.replay("resolve", ENDLESS, "endless", *words), "endless", self.capture, "running resolve/hit: not done within 2 s")
        self.capture = tiny

    def test_the_limit_is_checked(self):
        for text in ("0", "1.5", "-1", "9999999999"):
            self.refused(self.replay("resolve", INSIDE, "limit", "--dispatch-limit", text), "limit", "dispatch-limit")
            self.refused(self.replay("resolve", INSIDE, "limit", GLINT_DISPATCH_LIMIT=text), "limit", f"GLINT_DISPATCH_LIMIT={text}")

    def test_what_lies_outside_is_not_reached(self):
        for name, text in (("outside", OUTSIDE), ("inside", INSIDE)):
            run = self.replay("resolve", text, name)
            assert run.returncode == 0, run.stderr
        self.same("inside", "outside")

    def test_what_lies_outside_of_a_buffer_is_not_reached(self):
        with open(os.path.join(PASSES, "reflection", "classify_tiles", "shown.comp"), encoding="utf-8") as file:
            shown = file.read()
        end = "make_list(tile_list, dispatch_phase, 1.0); }"
        assert end in shown
        stores = "for (int i = 0; i < 40; i++) { imageStore(tile_list, (1 << 20) + (i << 26), uvec4(7u)); imageStore(tile_list, -1 - (1 << i), uvec4(7u)); }"
        for name, text in (("list", shown), ("far", shown.replace(end, end[:-1] + stores + " }"))):
            run = self.replay("classify_tiles", text, name, preset="mafia3")
            assert run.returncode == 0, run.stderr
        self.same("list", "far")

    def test_what_does_not_compile_within_the_limits_is_refused(self):
        self.write("other.glsl", '#include "other.glsl"\n#include "other.glsl"\n')
        for name, (text, said) in REFUSED.items():
            file = "other.glsl" if name == "cycle" else name + ".comp"
            self.refused(self.replay("resolve", text, name), name, self.path(file), said)

    def test_a_loop_is_not_unrolled_without_end(self):
        run = self.replay("resolve", START + body("[[unroll]] for (int i = 0; i < 50000000; i++) sum += sin(sum * float(i));"), "unrolled")
        assert run.returncode == 0, run.stderr

    def test_a_driver_that_never_ends_compiling_is_given_up(self):
        run = self.replay("resolve", INSIDE, "whole")
        assert run.returncode == 0, run.stderr
        layer = {"VK_LAYER_PATH": sys.argv[2], "VK_INSTANCE_LAYERS": "VK_LAYER_GLINT_fault", "GLINT_FAULT_CALL": "vkCreateComputePipelines", "GLINT_FAULT_SECONDS": "1000"}
        words = ["--all", "--passes", "resolve", "--inputs", self.path("whole"), "--dispatch-limit", "1"]
        self.refused(self.replay("resolve", INSIDE, "slow", *words, **layer), "slow", self.capture, "resolve/hit: not compiled by the driver within 1 s")

    def finish(self):
        shutil.rmtree(self.folder)


class AllShaders(Shaders):
    def test_macros_that_expand_to_nothing(self):
        """No memory, but time: billions of them."""
        self.refused(self.replay("resolve", START + expanding("", 10, 11) + body("A11"), "nothing"), "nothing", self.path("nothing.comp"), "takes more than 20 s, the limit")


    def test_what_compiles_to_too_much_is_refused(self):
        turns = "".join(f"v[{i % 3}] = sin(v[{(i + 1) % 4}]) * v[{i % 4}] + {i}.0;" for i in range(12000))
        text = START + body("vec4 v[4]; for (int i = 0; i < 4; i++) v[i] = vec4(i);" + turns + "sum = v[0].x;")
        self.refused(self.replay("resolve", text, "large"), "large", self.path("large.comp"), "more than 1 MiB, the limit")

    def test_a_server_goes_on_after_a_loop_without_end(self):
        """lavapipe's threads work on it for a while, beside the new device."""
        shader, capture = self.write("own.comp", INSIDE), self.path("shown.exr")
        tap.glint("sample", "street", "--light=1", "-o", capture, "--size", "256x144", "--cube-size", "8")
        with Live(sys.argv[1], capture, "--preset", tap.PLAIN, "--shader", f"resolve={shader}", env={**os.environ, "GLINT_DISPATCH_LIMIT": "20"}) as live:
            before = live.post("run", state={})["run"]
            self.write("own.comp", ENDLESS)
            try:
                live.post("run", state={})
            except Refused as refusal:
                assert (refusal.status, refusal.code) == (500, "device") and "running resolve/hit: not done within 20 s" in refusal.message, refusal
            else:
                raise AssertionError("the shader ended")
            self.write("own.comp", INSIDE.replace("0.25", "0.5"))
            assert live.post("run", state={})["run"] != before


tests = AllShaders() if len(sys.argv) > 3 else Shaders()
try:
    failed = tap.run(tests)
finally:
    tests.finish()
sys.exit(failed)
