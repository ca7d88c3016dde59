"""An outdoor scene: blender -b --factory-startup -P yard.py -- -o yard.blend. A yard after rain under a physical sky: puddles on rough asphalt (a noise
drives the roughness), houses, a car-like block, poles; the camera moves."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import shapes  # noqa: E402
from shapes import Material, box, cylinder, sphere  # noqa: E402

scene = shapes.start(nishita=25)
shapes.sun(scene, elevation=25, direction=200, strength=3)

ground = Material("asphalt", (0.06, 0.06, 0.065)).noise("Roughness", 0.04, 0.6, scale=0.45, low=0.46, high=0.58)
box("ground", (-40, -20, -0.5), (40, 60, 0), ground)
brick = Material("brick", (0.4, 0.16, 0.1), roughness=0.85).checker("Base Color", (0.4, 0.16, 0.1), (0.3, 0.12, 0.08), 0.5)
pale, glass = Material("render", (0.75, 0.68, 0.5), roughness=0.9), Material("windows", (0.02, 0.03, 0.04), roughness=0.05)
box("house left", (-12, 6, 0), (-5, 20, 7), brick)
box("house back", (-5, 20, 0), (9, 26, 5), pale)
box("house right", (7, 4, 0), (13, 17, 9), pale)
for i in range(4):
    box(f"window {i}", (-3.6 + 3 * i, 19.95, 1.4), (-2.0 + 3 * i, 20.05, 3.6), glass)
    box(f"window right {i}", (6.95, 5.2 + 3 * i, 2.0), (7.05, 6.8 + 3 * i, 4.6), glass)
body = Material("paint", (0.6, 0.03, 0.03), roughness=0.15)
box("car", (-3.4, 9, 0.35), (-1.5, 13, 1.0), body)
box("cabin", (-3.25, 9.9, 1.0), (-1.65, 12.2, 1.6), glass)
for i, (x, y) in enumerate(((-3.3, 9.8), (-1.6, 9.8), (-3.3, 12.2), (-1.6, 12.2))):
    cylinder(f"wheel {i}", (x, y, 0.36), 0.36, 0.25, Material("rubber", (0.02, 0.02, 0.02), roughness=0.8), axis="x")
for i, y in enumerate((6, 10, 14)):
    cylinder(f"post {i}", (4.2, y, 1.5), 0.12, 3, Material("post", (0.1, 0.3, 0.6), roughness=0.4))
    sphere(f"lamp {i}", (4.2, y, 3.15), 0.22, Material("lamp", (0, 0, 0), glow=((1, 0.75, 0.4), 4)))
sphere("steel", (1.6, 8.5, 0.9), 0.9, Material("steel", (0.8, 0.8, 0.82), roughness=0.1, metalness=1))
box("bench", (1.0, 13.2, 0.4), (3.2, 13.8, 0.5), Material("planks", (0.45, 0.28, 0.14), roughness=0.6))
for x in (1.1, 2.9):
    box(f"leg {x}", (x, 13.3, 0), (x + 0.2, 13.7, 0.4), Material("planks", (0.45, 0.28, 0.14), roughness=0.6))

shapes.camera(scene, [(1, (0.6, -1.8, 1.7), (0.2, 12, 1.0)), (3, (0.72, -1.56, 1.7), (0.2, 12, 1.0))], lens=28)
shapes.save(scene, frame=2)
