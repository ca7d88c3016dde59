"""Calls of Vulkan that fail, by tests/replay/fault_layer.c: every function that a replay calls, from its first calls to its last one, with each result.

faults.py GLINT LAYER_FOLDER [all]
"""
import collections
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap  # noqa: E402

RESULTS = {"VK_ERROR_DEVICE_LOST": "the device was lost", "VK_ERROR_OUT_OF_DEVICE_MEMORY": "out of device memory",
           "VK_ERROR_OUT_OF_HOST_MEMORY": "out of host memory", "VK_TIMEOUT": "an unexpected result"}
# What happens before a device or a capture is there, as two layouts that are made with the device, names neither; vkDeviceWaitIdle only ends what is over.
EARLY = {"vkCreateInstance", "vkEnumeratePhysicalDevices", "vkCreateDevice", "vkCreateCommandPool", "vkAllocateCommandBuffers", "vkCreateFence",
         "vkCreatePipelineCache", "vkCreateSampler"}
HARMLESS = {"vkDeviceWaitIdle"}
PRESET = "kf2"


class Faults:
    def __init__(self, everything):
        self.everything = everything
        self.folder = tempfile.mkdtemp(prefix="glint-faults-")
        self.capture = os.path.join(self.folder, "tiny.exr")
        tap.glint("sample", "street", "--light=1", "-o", self.capture, "--size", "32x18", "--cube-size", "8")
        self.counts = self.count("replay", self.capture, "--preset", PRESET, "-o", os.path.join(self.folder, "whole"))
        self.slots = {name.split("-", 1)[1][:-4] for name in os.listdir(os.path.join(self.folder, "whole")) if name != "run.json"}

    def environment(self, **fault):
        # The driver keeps memory of its own; what of Vulkan is not destroyed, the layer tells.
        leaks = os.path.join(self.folder, "leaks")
        with open(leaks, "w", encoding="utf-8") as file:
            file.write("leak:libvulkan_lvp\nleak:libLLVM\n")
        layers = {"LSAN_OPTIONS": f"suppressions={leaks}:print_suppressions=0", "GLINT_FAULT_STAY": "libvulkan_lvp.so", "VK_LAYER_PATH": sys.argv[2], "VK_INSTANCE_LAYERS": "VK_LAYER_GLINT_fault"}
        return {**os.environ, **layers, **{f"GLINT_FAULT_{name}": str(value) for name, value in fault.items()}}

    def run(self, *words, **fault):
        return subprocess.run([sys.argv[1], *words], capture_output=True, text=True, env=self.environment(**fault), timeout=120)

    def count(self, *words):
        path = os.path.join(self.folder, "counts")
        run = self.run(*words, COUNTS=path)
        assert run.returncode == 0, run.stderr
        counts = collections.Counter()
        with open(path, encoding="utf-8") as lines:
            for line in lines:
                name, number = line.split()
                counts[name] += int(number)
        return counts

    def numbers(self, call):
        """Which calls of a function fail: all, or the first, the last, and of many one in between."""
        last = self.counts[call]
        return range(1, last + 1) if self.everything else sorted({1, (last + 1) // 2 if last > 20 else 1, last})

    def results(self, call, number):
        return list(RESULTS) if self.everything else [list(RESULTS)[(number + len(call)) % 4], "VK_ERROR_DEVICE_LOST"][:1 if number > 1 else 2]

    def expect(self, call, number, result, times=0):
        """One replay: it fails with a message that says what and where, and leaves no folder."""
        out = os.path.join(self.folder, f"{call}-{number}-{result}")
        run = self.run("replay", self.capture, "--preset", PRESET, "-o", out, CALL=call, FROM=number, RESULT=result, TIMES=times)
        said = f"{call} {number} {result}: exit {run.returncode}\n{run.stderr}"
        assert run.returncode in (1, 2, 3, 4, 5), said
        assert not any(word in run.stderr for word in ("Sanitizer", "runtime error", "not destroyed")), said
        waited = call == "vkWaitForFences" and result == "VK_TIMEOUT"
        assert ("so the device was given up" if waited else RESULTS[result]) in run.stderr, said
        assert call in EARLY or self.capture in run.stderr or (call.endswith("DescriptorSetLayout") and number <= 2) or self.before_capture(call, number), said
        assert not os.path.exists(out), (said, os.listdir(out))
        return run.stderr

    def before_capture(self, call, number):
        """The buffer of the frame is made with the replay."""
        return number == 1 and call in ("vkCreateBuffer", "vkAllocateMemory", "vkMapMemory", "vkBindBufferMemory")

    def test_every_call_that_fails_is_told(self):
        calls = sorted(set(self.counts) - HARMLESS)
        faults = [(call, number, result) for call in calls for number in self.numbers(call) for result in self.results(call, number)]
        table, badly = collections.defaultdict(lambda: [0, 0]), []
        for (call, number, result), error in zip(faults, tap.failures(self.expect, faults, os.cpu_count() if self.everything else 1)):
            row = table[call, result]
            row[0] += 1
            if error:
                row[1] += 1
                badly.append(str(error))
        print(f"# {len(faults)} replays with faults in {len(calls)} functions")
        if self.everything:
            print("# | function | error | tried | failed well | badly |\n# | --- | --- | --- | --- | --- |")
            for (call, result), (times, bad) in sorted(table.items()):
                print(f"# | {call} | {result} | {times} | {times - bad} | {bad} |")
        assert not badly, badly[:5]
        assert len(calls) >= 25 and len(faults) > 60

    def test_a_pass_that_runs_is_named(self):
        """The last submissions read images back, those before them run passes, and the first ones upload images."""
        named = set()
        for call in ("vkWaitForFences", "vkGetQueryPoolResults"):
            for number in range(max(1, self.counts[call] - 20), self.counts[call] + 1):
                said = self.expect(call, number, "VK_ERROR_DEVICE_LOST")
                named |= {slot for slot in self.slots if f"running {slot}/" in said}
        assert self.slots <= named, (self.slots, named)

    def test_waiting_without_end_does_no_harm(self):
        for result in RESULTS:
            run = self.run("replay", self.capture, "--preset", PRESET, CALL="vkDeviceWaitIdle", RESULT=result)
            assert run.returncode == 0, run.stderr

    def test_devices_that_cannot_be_listed(self):
        for result, text in RESULTS.items():
            for call in ("vkCreateInstance", "vkEnumeratePhysicalDevices"):
                run = self.run("devices", CALL=call, RESULT=result)
                assert run.returncode != 0 and text in run.stderr, (call, result, run)

    def test_an_old_run_outlives_a_fault(self):
        """A run that fails before it writes leaves the folder of an earlier one as it is."""
        out = os.path.join(self.folder, "kept")
        run = self.run("replay", self.capture, "--preset", PRESET, "-o", out)
        assert run.returncode == 0, run.stderr
        before = sorted(os.listdir(out))
        run = self.run("replay", self.capture, "--preset", PRESET, "-o", out, CALL="vkWaitForFences", FROM=20)
        assert run.returncode != 0 and sorted(os.listdir(out)) == before, run

    def finish(self):
        shutil.rmtree(self.folder)


tests = Faults(len(sys.argv) > 3)
try:
    failed = tap.run(tests)
finally:
    tests.finish()
sys.exit(failed)
