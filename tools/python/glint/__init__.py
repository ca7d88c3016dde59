"""Captures and runs of glint as NumPy arrays, over libglint-capture.

    capture = glint.open("frame.exr")              # Capture: frame, parts
    depth = capture["gbuffer"].read("depth.Z")     # (height, width) float32, metres
    normal = capture["gbuffer"].read("normal")     # (height, width, 3) float32, world space
    with glint.Writer("copy.exr", capture.frame) as writer:
        writer.add("gbuffer", {"depth.Z": depth, "normal": normal, …})
    run = glint.Run("run")                         # Run: passes, images
    travelled = run["travelled"].read()

docs/python.md explains it with examples. What the library or a file refuses is raised as glint.Error; wrong types, shapes and names of the
caller's are TypeError, ValueError and KeyError. Importing raises ImportError where the library is missing or does not fit.
"""
from glint.capture import Attribute, Capture, Channel, Part, Violation, faces, open, validate
from glint.frame import (Atmosphere, Camera, Clouds, Cone, CubeMap, Encodings, Fog, Frame, Froxels, Indirect, Light, LightVolume, MaterialModel, Planar, Probe, ProbeBox, Shadow, Sky,
                         StencilClass, Sun, Truth)
from glint.library import Error
from glint.registry import Role, RoleChannel, roles
from glint.run import Image, Pass, Run, Times
from glint.writer import Writer

__all__ = ["Atmosphere", "Attribute", "Camera", "Capture", "Channel", "Clouds", "Cone", "CubeMap", "Encodings", "Error", "Fog", "Frame", "Froxels", "Image", "Indirect", "Light", "LightVolume",
           "MaterialModel", "Part", "Pass", "Planar", "Probe", "ProbeBox", "Role", "RoleChannel", "Run", "Shadow", "Sky", "StencilClass", "Sun", "Times", "Truth",
           "Violation", "Writer", "faces", "open", "roles", "validate"]
