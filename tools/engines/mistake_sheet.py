"""A sheet of what mistakes look like: the same crop of the right reflection and of the mistaken one, labelled with the number of the table's row."""
import shutil
import subprocess

CUT = "280x158+130+150"  # the karts, and the road before them
COLUMNS = 4
LABEL = "--text:x=5:y=26:size=24:color=1,1,1:shadow=2:font=/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"


def take(glint, folder, number, preset):
    """The reflection of folder/mistaken.exr as a picture; none where the replay refuses the capture."""
    run = folder / "run"
    shutil.rmtree(run, ignore_errors=True)
    picture = folder / f"{number}-{preset}.png"
    picture.unlink(missing_ok=True)
    replay = subprocess.run([glint, "replay", folder / "mistaken.exr", "-p", preset, "-o", run, "--outputs", "reflection"], capture_output=True, text=True)
    if replay.returncode == 0:
        subprocess.run([glint, "view", run, "--image", "reflection", "--no-legend", "--exposure", "2", "-o", picture], check=True, capture_output=True)


def lay_out(folder, rows, path):
    """rows: numbers and presets; number 0 is the right one."""
    tiles = []
    for number, preset in rows:
        wrong, right, tile = folder / f"{number}-{preset}.png", folder / f"0-{preset}.png", folder / f"tile-{number}.png"
        if not number or not wrong.exists():
            continue
        subprocess.run(["oiiotool", right, "--ch", "R,G,B", "--cut", CUT, wrong, "--ch", "R,G,B", "--cut", CUT, "--mosaic:pad=2", "2x1",
                        LABEL, str(number), "-o", tile], check=True)
        tiles.append(tile)
    lines = (len(tiles) + COLUMNS - 1) // COLUMNS
    subprocess.run(["oiiotool", "--nosoftwareattrib", *tiles, "--mosaic:pad=8", f"{COLUMNS}x{lines}", "--resize", "1400x0", "--compression", "jpeg:80", "-o", path], check=True)
