"""The panel of the add-on. The dump itself runs in a background Blender on a copy of the file, as the script does: the scene stays as it is."""
import os
import subprocess
import tempfile

import bpy

from . import options

_running = None  # the background process, its log and the copy of the file


def _property(kind, default, text):
    if isinstance(kind, tuple):
        return bpy.props.EnumProperty(items=[(word, word, "") for word in kind], default=default, description=text)
    return {int: bpy.props.IntProperty, float: bpy.props.FloatProperty, str: bpy.props.StringProperty}[kind](default=default, description=text)


class GlintCaptureSettings(bpy.types.PropertyGroup):
    __annotations__ = {"output": bpy.props.StringProperty(name="output", subtype="FILE_PATH", default="//frame.exr", description="the capture"),
                       **{name: _property(kind, default, text) for name, kind, default, text in options.ROWS}}


def command(scene, blend):
    """The words that start the script with the fields' values."""
    wanted = scene.glint_capture
    words = [bpy.app.binary_path, "-b", blend, "--python-exit-code", "1", "-P", os.path.join(os.path.dirname(os.path.abspath(__file__)), "run.py"),
             "--", "-o", bpy.path.abspath(wanted.output)]
    for name, _, default, _ in options.ROWS:
        value = getattr(wanted, name)
        if value != default:
            words += ["--" + name.replace("_", "-"), str(value)]
    return words


class GlintCapture(bpy.types.Operator):
    """Dump the current frame as a capture for glint"""
    bl_idname = "render.glint_capture"
    bl_label = "glint capture"

    @classmethod
    def poll(cls, context):
        return _running is None and context.scene.camera is not None

    def execute(self, context):
        global _running
        folder = tempfile.mkdtemp(prefix="glint-capture-")
        blend = os.path.join(folder, "scene.blend")
        bpy.ops.wm.save_as_mainfile(filepath=blend, copy=True, relative_remap=True)
        log = open(os.path.join(folder, "log.txt"), "w", encoding="utf-8")
        process = subprocess.Popen(command(context.scene, blend), stdout=log, stderr=subprocess.STDOUT)
        if bpy.app.background:  # no window whose timer could wait
            return self.end(process.wait(), log)
        _running = process, log
        self.timer = context.window_manager.event_timer_add(0.5, window=context.window)
        context.window_manager.modal_handler_add(self)
        self.report({"INFO"}, f"glint capture runs; log: {log.name}")
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        global _running
        process, log = _running
        if event.type != "TIMER" or process.poll() is None:
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self.timer)
        _running = None
        return self.end(process.returncode, log)

    def end(self, status, log):
        log.close()
        with open(log.name, encoding="utf-8", errors="replace") as text:
            said = [line.strip() for line in text if line.startswith(("glint", "glint_capture:"))]
        if status:
            self.report({"ERROR"}, "\n".join(said[-3:] + [f"glint capture failed; log: {log.name}"]))
            return {"CANCELLED"}
        for line in said:
            self.report({"INFO"}, line)
        os.unlink(os.path.join(os.path.dirname(log.name), "scene.blend"))
        return {"FINISHED"}


class GlintCapturePanel(bpy.types.Panel):
    bl_idname = "RENDER_PT_glint_capture"
    bl_label = "glint capture"
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.layout.use_property_split = True
        for name in ("output", *(row[0] for row in options.ROWS)):
            self.layout.prop(context.scene.glint_capture, name)
        self.layout.operator(GlintCapture.bl_idname)


def _menu(self, context):
    self.layout.separator()
    self.layout.operator(GlintCapture.bl_idname)


CLASSES = (GlintCaptureSettings, GlintCapture, GlintCapturePanel)


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Scene.glint_capture = bpy.props.PointerProperty(type=GlintCaptureSettings)
    bpy.types.TOPBAR_MT_render.append(_menu)


def unregister():
    bpy.types.TOPBAR_MT_render.remove(_menu)
    del bpy.types.Scene.glint_capture
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
