"""Cameras: Blender's as glint's matrices, and those that look along the faces of a cube map."""
import math

import bpy
import mathutils
import numpy as np


class Refused(Exception):
    """What this tool cannot capture, in words for whoever asked."""


class Camera:
    """A perspective camera in the picture that it renders. World and view are Blender's own: right-handed, z up, the view looks along -z."""

    def __init__(self, scene, camera, depsgraph):
        if camera is None:
            raise Refused(f"the scene {scene.name} has no camera")
        if camera.data.type != "PERSP":
            raise Refused(f"the camera {camera.name} is {camera.data.type.lower()}; a capture needs a perspective camera")
        render = scene.render
        self.width, self.height = picture_size(scene)
        evaluated = camera.evaluated_get(depsgraph)
        # sensor fit, shift and the shape of pixels are in it; NDC z is OpenGL's
        self.view_to_clip = np.array(evaluated.calc_matrix_camera(
            depsgraph, x=self.width, y=self.height, scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y), np.float64)
        world = np.array(evaluated.matrix_world, np.float64)
        # Blender ignores a camera's scale. Its matrix is of floats: the nearest rotation in double keeps the position exact.
        u, _, v = np.linalg.svd(world[:3, :3] / np.linalg.norm(world[:3, :3], axis=0))
        rotation = (u @ v).T
        self.position = world[:3, 3]
        self.world_to_view = np.eye(4)
        self.world_to_view[:3, :3] = rotation
        self.world_to_view[:3, 3] = -rotation @ self.position

    def directions(self):
        """For each pixel's centre the world direction whose component along the view axis is 1."""
        x = 2 * (np.arange(self.width) + 0.5) / self.width - 1
        y = 1 - 2 * (np.arange(self.height) + 0.5) / self.height
        c = self.view_to_clip
        view = np.empty((self.height, self.width, 3))
        view[..., 0] = (x[None, :] + c[0, 2]) / c[0, 0]
        view[..., 1] = (y[:, None] + c[1, 2]) / c[1, 1]
        view[..., 2] = -1
        return view @ self.world_to_view[:3, :3]

    def positions(self, depth):
        """World positions of a depth along the view axis, NaN where it is infinite."""
        return self.position + self.directions() * np.where(np.isfinite(depth), depth, np.nan)[..., None]


def picture_size(scene):
    render = scene.render
    return (max(1, render.resolution_x * render.resolution_percentage // 100), max(1, render.resolution_y * render.resolution_percentage // 100))


# Forward and up of the faces +X -X +Y -Y +Z -Z in the world's axes, as FORMAT.md orients them. Seen from inside they are mirrored: their right
# is up × forward, where that of a camera in a right-handed world is forward × up.
FACES = (((1, 0, 0), (0, 1, 0)), ((-1, 0, 0), (0, 1, 0)), ((0, 1, 0), (0, 0, -1)),
         ((0, -1, 0), (0, 0, 1)), ((0, 0, 1), (0, 1, 0)), ((0, 0, -1), (0, 1, 0)))


def face_matrix(face, position):
    """The matrix_world of a camera that looks along a face."""
    forward, up = (mathutils.Vector(v) for v in FACES[face])
    matrix = mathutils.Matrix((forward.cross(up), up, -forward)).transposed().to_4x4()
    matrix.translation = position
    return matrix


def face_distance_scale(size):
    """Euclidean distance over distance along the axis, for the texels of a face."""
    s = 2 * (np.arange(size) + 0.5) / size - 1
    return np.sqrt(1 + s[None, :] ** 2 + s[:, None] ** 2).astype(np.float32)


def face_camera(scene, near, far):
    """A new camera of 90°, in the scene."""
    data = bpy.data.cameras.new("glint face")
    data.sensor_fit, data.angle = "HORIZONTAL", math.pi / 2
    data.clip_start, data.clip_end = near, far
    camera = bpy.data.objects.new("glint face", data)
    scene.collection.objects.link(camera)
    return camera
