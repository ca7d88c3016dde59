"""Frames of programs that RenderDoc captures, from their start to glint's replay. Run by ./dev engines renderdoc."""
import os
import pathlib
import shutil
import subprocess
import sys
import time

from steps import Steps, call

TOOLS = pathlib.Path(__file__).resolve().parent.parent / "renderdoc"
PYTHON = "/usr/bin/python3"  # Debian's own, for which its RenderDoc module is built
DISPLAY = f":{os.environ.get('GLINT_ENGINES_DISPLAY', 87)}"

# SuperTuxKart's settings. Its shaders are compiled for llvmpipe, which has no texture compression worth its time.
SETTINGS = """<?xml version="1.0"?>
<stkconfig version="8">
    <Video width="640" height="360" real_width="640" real_height="360" fullscreen="false" enable_texture_compression="false"
           enable_high_definition_textures="2" max_texture_size="512" hq_mipmap="true" enable_dynamic_lights="true" scale_rtts_factor="1.0"
           enable_glow="false" enable_bloom="false" enable_light_shaft="false" enable_dof="false" old_driver_popup="false" render_driver="gl"/>
    <GFX particles-effecs="0" animated-characters="true" geometry_level="0" anisotropic="4" swap-interval="0" motionblur_enabled="false"
         mlaa="false" ssao="true" light_scatter="true" shadows_resolution="0" Degraded_IBL="false"/>
</stkconfig>
"""
# What is started, the first of the two frames that are taken (0: as soon as possible), the mapping, and what it is replayed with. By its 100th frame the race has begun.
PROGRAMS = {
    "vkcube": (["/usr/bin/vkcube"], 0, "vkcube.json", ("kf2",)),
    "supertuxkart": (["/usr/games/supertuxkart", "--windowed", "--race-now", "--track=candela_city", "--numkarts=4", "--profile-laps=3", "--seed=1"],
                     100, "supertuxkart.json", ("kf2", "mafia3")),
}


def environment(home):
    (home / "cache").mkdir(parents=True, exist_ok=True)  # of compiled shaders, too
    return dict(os.environ, DISPLAY=DISPLAY, HOME=str(home), XDG_CONFIG_HOME=str(home / "config"), XDG_DATA_HOME=str(home / "data"),
                XDG_CACHE_HOME=str(home / "cache"), SDL_AUDIODRIVER="dummy", ALSOFT_DRIVERS="null", LIBGL_ALWAYS_SOFTWARE="1",
                PYTHONDONTWRITEBYTECODE="1")


def with_display(work):
    """Does the work while a display without a screen runs."""
    if os.path.exists(f"/tmp/.X11-unix/X{DISPLAY[1:]}"):
        sys.exit(f"engines.py: the display {DISPLAY} is in use; choose another number by GLINT_ENGINES_DISPLAY")
    server = subprocess.Popen(["Xvfb", DISPLAY, "-screen", "0", "640x360x24", "-nolisten", "tcp"], stderr=subprocess.DEVNULL)
    try:
        for _ in range(100):
            if os.path.exists(f"/tmp/.X11-unix/X{DISPLAY[1:]}") or server.poll() is not None:
                break
            time.sleep(0.1)
        if server.poll() is not None:
            sys.exit(f"engines.py: Xvfb {DISPLAY} ended at once")
        work()
    finally:
        server.terminate()
        server.wait()


def capture(folder, command, frame):
    home, taken = folder / "home", folder / "taken"
    settings = home / "config/supertuxkart/config-0.10"
    settings.mkdir(parents=True, exist_ok=True)
    (settings / "config.xml").write_text(SETTINGS)
    shutil.rmtree(taken, ignore_errors=True)
    call(PYTHON, TOOLS / "capture.py", "-o", taken, "--at", frame, "--frames", 2, "--timeout", 3 * 3600, "--", *command,
         into=folder / "program.log", env=dict(environment(home), LP_NUM_THREADS="0"))  # the game starts threads of its own
    for number in (0, 1):
        os.replace(taken / f"frame_{number}.rdc", folder / f"frame_{number}.rdc")


def list_passes(folder, number):
    call(PYTHON, TOOLS / "list_passes.py", folder / f"frame_{number}.rdc", "--json", "-o", folder / "passes.new",
         into=folder / "passes.log", env=environment(folder / "home"))
    os.replace(folder / "passes.new", folder / f"passes_{number}.json")


def dump(folder, mapping):
    shutil.rmtree(folder / "dump", ignore_errors=True)
    call(PYTHON, TOOLS / "dump.py", folder / "frame_1.rdc", TOOLS / mapping, "-o", folder / "dump",
         "--passes", folder / "passes_1.json", "--previous", folder / "frame_0.rdc", "--previous-passes", folder / "passes_0.json",
         into=folder / "dump.log", env=environment(folder / "home"))


def replay(glint, name, folder):
    """From the start of a program to the runs."""
    command, frame, mapping, presets = PROGRAMS[name]
    print(f"{name}: {folder}", flush=True)
    folder.mkdir(parents=True, exist_ok=True)
    steps = Steps(folder)
    steps.do("capture", ["frame_0.rdc", "frame_1.rdc"], lambda: with_display(lambda: capture(folder, command, frame)))
    for number in (0, 1):
        steps.do(f"passes of frame {number}", [f"passes_{number}.json"], lambda: with_display(lambda: list_passes(folder, number)))
    steps.do("map", ["dump/manifest.json"], lambda: with_display(lambda: dump(folder, mapping)))
    steps.pack(glint, "dump/manifest.json")
    steps.check(glint)
    for preset in presets:
        steps.replay(glint, preset, "-p", preset)


def mistakes(glint, folder, *options):
    call(PYTHON, pathlib.Path(__file__).with_name("mistakes.py"), glint, folder / "dump", folder / "mistakes", *options,
         into=folder / "mistakes.log", env=environment(folder / "home"))


def prove(glint, folder):
    for name in PROGRAMS:
        replay(glint, name, folder / name)
    folder = folder / "supertuxkart"
    Steps(folder).do("mistakes", ["mistakes/mistakes.json"], lambda: mistakes(glint, folder))
    print((folder / "mistakes.log").read_text().strip(), flush=True)


def pictures(glint, folder, docs):
    """The game's picture and glint's, and the reflections alone, two stops brighter (it is night); a sheet of mistakes, and their table in the page."""
    folder = folder / "supertuxkart"
    shown = [(folder / "frame.exr", "--part", "scene"), (folder / "frame.exr", "--part", "engine.upscale.reflection")]
    for preset in PROGRAMS["supertuxkart"][3]:
        shown += [(folder / preset, "--image", "composed"), (folder / preset, "--image", "reflection")]
    tiles = [folder / f"picture-{i}.png" for i in range(len(shown))]
    for tile, what in zip(tiles, shown):
        call(glint, "view", *what, "--no-legend", "--exposure", "2", "-o", tile)
    call("oiiotool", "--nosoftwareattrib", *tiles, "--mosaic:pad=4", f"2x{len(shown) // 2}", "--ch", "R,G,B", "--compression", "jpeg:82", "-o", docs / "supertuxkart.jpg")
    mistakes(glint, folder, "--sheet", docs / "mistakes.jpg", "--page", docs.parent / "engines.md")
