"""An indoor scene: blender -b --factory-startup -P hall.py -- -o hall.blend. A hall with a polished floor, lit by ceiling panels and a window; objects
from mirror to chalk, a tiled wall whose roughness is a texture; the camera moves."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import shapes  # noqa: E402
from shapes import Material, box, sphere  # noqa: E402

scene = shapes.start(sky=(0.35, 0.5, 0.8), strength=1.5)

# 9 m wide (x), 12 m deep (y), 3.6 m high; the camera looks along +y
floor = Material("floor", (0.12, 0.1, 0.09), roughness=0.08).checker("Base Color", (0.12, 0.1, 0.09), (0.3, 0.27, 0.22), 0.75)
white = Material("plaster", (0.72, 0.7, 0.66), roughness=0.9)
tiles = Material("tiles", (0.1, 0.22, 0.25)).checker("Roughness", 0.12, 0.55, 0.4)
red, blue = Material("red wall", (0.55, 0.08, 0.06), roughness=0.8), Material("blue wall", (0.06, 0.12, 0.45), roughness=0.8)
box("floor", (-4.5, -6, -0.2), (4.5, 6, 0), floor)
box("ceiling", (-4.5, -6, 3.6), (4.5, 6, 3.8), white)
box("back", (-4.5, 6, 0), (4.5, 6.2, 3.6), tiles)
box("front", (-4.5, -6.2, 0), (4.5, -6, 3.6), white)
box("left", (-4.7, -6, 0), (-4.5, 6, 3.6), red)
# the right wall has a window
box("right low", (4.5, -6, 0), (4.7, 6, 1.0), blue)
box("right high", (4.5, -6, 2.8), (4.7, 6, 3.6), blue)
box("right near", (4.5, -6, 1.0), (4.7, 1.0, 2.8), blue)
box("right far", (4.5, 4.5, 1.0), (4.7, 6, 2.8), blue)
for i, y in enumerate((-3.5, 0.5, 4.0)):
    box(f"panel {i}", (-1.2, y - 0.6, 3.54), (1.2, y + 0.6, 3.58), Material(f"panel {i}", (0, 0, 0), glow=((1, 0.86, 0.7), 6)))

box("plinth", (-2.6, 2.2, 0), (-1.4, 3.4, 0.9), Material("stone", (0.5, 0.48, 0.45), roughness=0.6))
sphere("copper", (-2.0, 2.8, 1.4), 0.5, Material("copper", (0.9, 0.5, 0.3), roughness=0.2, metalness=1))
sphere("mirror", (0.3, 1.6, 0.6), 0.6, Material("mirror", (0.9, 0.9, 0.9), roughness=0.02, metalness=1))
sphere("yellow", (1.7, 3.4, 0.45), 0.45, Material("yellow", (0.8, 0.55, 0.05), roughness=0.35))
box("crate", (2.4, 0.6, 0), (3.4, 1.6, 1.0), Material("wood", (0.4, 0.22, 0.1), roughness=0.5), turn=0.4)
box("pillar", (-3.6, -0.2, 0), (-3.1, 0.3, 3.6), Material("green", (0.1, 0.35, 0.15), roughness=0.3))
box("brushed", (0.9, 5.2, 0), (2.3, 5.5, 1.7), Material("brushed", (0.75, 0.77, 0.8), roughness=0.4, metalness=1))
sphere("chalk", (3.3, 4.9, 0.4), 0.4, Material("chalk", (0.85, 0.85, 0.85), roughness=1.0, specular=0.1))

shapes.probe("probe", (0, 1.2, 1.8))
shapes.probe("probe", (-2.2, 4.4, 1.6))
shapes.probe("probe", (2.2, 2.4, 1.7))
shapes.probe("probe", (0, -3.5, 1.8))
shapes.camera(scene, [(1, (0.9, -4.4, 1.5), (-0.1, 2.6, 0.75)), (3, (0.74, -4.24, 1.5), (-0.1, 2.6, 0.75))], lens=24)
shapes.save(scene, frame=2)
