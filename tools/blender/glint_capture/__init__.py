"""An add-on for Blender: glint capture, in the render properties."""
bl_info = {"name": "glint capture", "author": "the glint contributors", "version": (1, 0), "blender": (3, 4, 0), "category": "Render",
           "location": "Properties > Render > glint capture", "description": "Dumps a frame of Cycles as a capture for glint"}


def register():
    from . import panel
    panel.register()


def unregister():
    from . import panel
    panel.unregister()
