"""What a device may lack, by tests/replay/hide_layer.c, one thing at a time: a replay either gives the same bits, or ends with a message that names it.

hidden.py GLINT LAYER_FOLDER vulkan_core.h [all]
"""
import filecmp
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap  # noqa: E402

STRUCTS = ["VkPhysicalDeviceFeatures", "VkPhysicalDeviceVulkan11Features", "VkPhysicalDeviceVulkan12Features", "VkPhysicalDeviceVulkan13Features",
           "VkPhysicalDeviceRobustness2FeaturesEXT"]
REQUIRED = {"imageCubeArray", "shaderStorageImageWriteWithoutFormat", "synchronization2", "maintenance4"}
# Those that do without, beside REQUIRED, in the short form: what glint uses where it is there, and one of each kind that it does not use.
SAMPLED = REQUIRED | {"robustBufferAccess", "robustImageAccess", "robustBufferAccess2", "robustImageAccess2", "shaderFloat64", "timelineSemaphore", "multiview"}
LIMITS = ["maxImageDimension2D", "maxImageDimensionCube", "maxImageArrayLayers", "maxTexelBufferElements", "maxUniformBufferRange", "maxStorageBufferRange", "maxPushConstantsSize",
          "maxMemoryAllocationCount", "maxSamplerAllocationCount", "maxBoundDescriptorSets", "maxPerStageDescriptorSamplers", "maxPerStageDescriptorUniformBuffers",
          "maxPerStageDescriptorStorageBuffers", "maxPerStageDescriptorSampledImages", "maxPerStageDescriptorStorageImages", "maxPerStageResources", "maxComputeSharedMemorySize",
          "maxComputeWorkGroupInvocations"]
SAMPLED_LIMITS = {"maxTexelBufferElements", "maxPerStageDescriptorSampledImages", "maxPerStageDescriptorStorageImages", "maxComputeWorkGroupInvocations"}
FORMATS = {13: "R8UI", 98: "R32UI", 76: "R16F", 83: "RG16F", 97: "RGBA16F", 100: "R32F", 103: "RG32F", 109: "RGBA32F"}  # of VkFormat
EXTENSIONS = ["VK_EXT_robustness2", "VK_KHR_maintenance4", "VK_KHR_synchronization2"]  # the two others are part of Vulkan 1.3


class Hidden:
    def __init__(self):
        self.everything = len(sys.argv) > 4
        self.presets = ["mafia_de_frame", "reference"] if self.everything else ["plain"]
        self.folder = tempfile.mkdtemp(prefix="glint-hidden-")
        self.capture = os.path.join(self.folder, "tiny.exr")
        tap.glint("sample", "street", "--light=1", "-o", self.capture, "--size", "32x18", "--cube-size", "8")
        self.same, self.refused = [], []
        for preset in self.presets:
            run = self.replay(preset, "nothing", preset)
            assert run.returncode == 0, run.stderr

    def replay(self, preset, what, out):
        environment = {**os.environ, "VK_LAYER_PATH": sys.argv[2], "VK_INSTANCE_LAYERS": "VK_LAYER_GLINT_hide", "GLINT_HIDE": what}
        words = ["replay", self.capture, "--preset", tap.PLAIN if preset == "plain" else preset, "-o", os.path.join(self.folder, out)]
        return subprocess.run([sys.argv[1], *words], capture_output=True, text=True, env=environment, timeout=300)

    def hide(self, *things):
        """(WHAT, NAME, REFUSED) each; the last: whether it has to be refused, None for either."""
        items = [(*thing, preset) for thing in things for preset in self.presets]
        errors = [str(error) for error in tap.failures(self.hide_one, items, os.cpu_count() if self.everything else 1) if error]
        assert not errors, errors[:5]

    def hide_one(self, what, name, refused, preset):
        folder = os.path.join(self.folder, f"{preset}-{what}")
        run = self.replay(preset, what, folder)
        said = (preset, what, name, run.returncode, run.stderr)
        assert "hide layer" not in run.stderr, said
        if run.returncode == 0:
            assert not refused, said
            files = sorted(f for f in os.listdir(folder) if f.endswith(".exr"))
            assert files == sorted(f for f in os.listdir(os.path.join(self.folder, preset)) if f.endswith(".exr")), said
            _, other, broken = filecmp.cmpfiles(folder, os.path.join(self.folder, preset), files, shallow=False)
            assert files and not other and not broken, (said, other, broken)
            shutil.rmtree(folder)
            self.same.append(what)
        else:
            assert refused is not False and run.returncode in (1, 2, 3, 4, 5) and name in run.stderr, said
            assert not os.path.exists(folder), said
            self.refused.append(what)

    def test_features(self):
        with open(sys.argv[3], encoding="utf-8") as file:
            header = file.read()
        hidden = []
        for struct in STRUCTS:
            body = re.search(r"typedef struct " + struct + r" \{(.*?)\}", header, re.S).group(1)
            for number, name in enumerate(re.findall(r"VkBool32\s+(\w+);", body)):
                if self.everything or name in SAMPLED:
                    hidden.append((f"{struct}:{number}", name, name in REQUIRED))
        self.hide(*hidden)
        assert SAMPLED <= {name for _, name, _ in hidden}
        print(f"# {len(hidden)} features")

    def test_extensions(self):
        self.hide(*((f"extension:{name}", name, False) for name in EXTENSIONS))

    def test_limits(self):
        self.hide(*((f"limit:{name}", name, None) for name in LIMITS if self.everything or name in SAMPLED_LIMITS))

    def test_formats(self):
        self.hide(*((f"format:{number}", name, True) for number, name in FORMATS.items() if self.everything or name in ("R8UI", "RGBA16F")))

    def test_timestamps(self):
        self.hide(("timestamps", "timestamps", False))

    def finish(self):
        shutil.rmtree(self.folder)
        print(f"# {len(self.same)} replays with the same bits, {len(self.refused)} refused")
        assert len(self.same) > 5 and len(self.refused) > 5


tests = Hidden()
try:
    failed = tap.run(tests)
finally:
    tests.finish()
sys.exit(failed)
