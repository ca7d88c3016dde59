"""A RenderDoc capture: its passes as plain dictionaries, images and constants at an event. The only file that needs RenderDoc.

Works with the API-neutral part of RenderDoc's Python module (1.24 and later): OpenGL, Vulkan and Direct3D captures look the same, but
for the order of an image's rows.
"""
import sys

import texels

SMALL_DRAW = 6  # vertices of a draw that covers the screen: two triangles or less
MANY = 8        # more small draws after each other into the same targets are particles or text, not full-screen passes


class CaptureError(Exception):
    """The capture cannot be opened or read."""


def import_renderdoc(folder=None):
    if folder:
        sys.path.insert(0, folder)
    try:
        import renderdoc
    except ImportError as error:
        raise CaptureError(f"RenderDoc's Python module cannot be loaded ({error}); on Debian: apt-get install python3-renderdoc, and "
                           "run /usr/bin/python3, the only Python that it was built for; elsewhere give --module the folder of renderdoc.so or .pyd") from None
    return renderdoc


class Names:
    """Names of an enumeration's numbers, which RenderDoc's module prints as integers."""

    def __init__(self, enumeration):
        self.names = {}
        for name in dir(enumeration):
            value = getattr(enumeration, name)
            if not name.startswith("_") and isinstance(value, int) and not callable(value):
                self.names.setdefault(int(value), name)

    def __getitem__(self, value):
        return self.names.get(int(value), str(int(value)))


class Capture:
    """An open capture; close it, or use it in a with statement."""
    ready = False  # RenderDoc is initialised once a process

    def __init__(self, path, module=None):
        self.path, self.rd = path, import_renderdoc(module)
        rd = self.rd
        if not Capture.ready:
            rd.InitialiseReplay(rd.GlobalEnvironment(), [])
            Capture.ready = True
        self.file = rd.OpenCaptureFile()
        result = self.file.OpenFile(path, "", None)
        if result.code != rd.ResultCode.Succeeded:
            raise CaptureError(f"{path}: {result.Message()}")
        if not self.file.LocalReplaySupport():
            raise CaptureError(f"{path}: this machine cannot replay it ({self.file.DriverName()})")
        result, self.controller = self.file.OpenCapture(rd.ReplayOptions(), None)
        if result.code != rd.ResultCode.Succeeded:
            raise CaptureError(f"{path}: {result.Message()}; a DISPLAY is needed, Xvfb's is enough")
        self.api = Names(rd.GraphicsAPI)[self.controller.GetAPIProperties().pipelineType]
        self.textures = {int(t.resourceId): t for t in self.controller.GetTextures()}
        self.resources = {int(r.resourceId): r.name for r in self.controller.GetResources()}
        self.kinds, self.types, self.shapes = Names(rd.CompType), Names(rd.ResourceFormatType), Names(rd.TextureType)
        self.variables = Names(rd.VarType)
        self.event = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.controller.Shutdown()
        self.file.Shutdown()

    def at(self, event):
        if self.event != event:
            self.controller.SetFrameEvent(event, True)
            self.event = event

    # What the frame does.

    def actions(self):
        """All draws and dispatches of the frame, in order."""
        flags = self.rd.ActionFlags
        found = []

        def walk(actions):
            for action in actions:
                if action.flags & (flags.Drawcall | flags.Dispatch):
                    found.append(action)
                walk(action.children)

        walk(self.controller.GetRootActions())
        return found

    def runs(self):
        """Draws after each other into the same targets; one that may cover the screen stands alone."""
        def targets(action):
            return [int(o) for o in action.outputs], int(action.depthOut), bool(action.flags & self.rd.ActionFlags.Dispatch)

        def small(action):
            return bool(action.flags & self.rd.ActionFlags.Dispatch) or (action.numIndices <= SMALL_DRAW and action.numInstances <= 1)

        runs = []
        for action in self.actions():
            last = runs[-1][-1] if runs else None
            if last is not None and targets(last) == targets(action) and small(last) == small(action):
                runs[-1].append(action)
            else:
                runs.append([action])
        for run in runs:
            if small(run[0]) and len(run) <= MANY:
                yield from ([action] for action in run)
            else:
                yield run

    def passes(self, progress=None):
        """The frame's passes, as list_passes.py writes them: shaders are those of a pass's last draw."""
        found = []
        for index, run in enumerate(self.runs()):
            last = run[-1]
            self.at(last.eventId)
            entry = self.describe(run)
            entry["index"] = index
            found.append(entry)
            if progress:
                progress(entry)
        return found

    def describe(self, run):
        state = self.controller.GetPipelineState()
        last = run[-1]
        dispatch = bool(last.flags & self.rd.ActionFlags.Dispatch)
        stages = {"compute": self.rd.ShaderStage.Compute} if dispatch else {"fragment": self.rd.ShaderStage.Fragment, "vertex": self.rd.ShaderStage.Vertex}
        outputs = [] if dispatch else [self.bound(o) for o in state.GetOutputTargets()]
        while outputs and outputs[-1] is None:
            outputs.pop()
        return {"kind": "dispatch" if dispatch else "draw", "first_event": run[0].eventId, "last_event": last.eventId, "draws": len(run),
                "vertices": sum(a.numIndices * max(a.numInstances, 1) for a in run), "outputs": outputs,
                "depth": None if dispatch else self.bound(state.GetDepthTarget()),
                "shaders": {name: shader for name, stage in stages.items() if (shader := self.shader(state, stage))}}

    def shader(self, state, stage):
        reflection = state.GetShaderReflection(stage)
        if reflection is None:
            return None
        samplers = []
        for kind, resources, bound in (("sampled", reflection.readOnlyResources, state.GetReadOnlyResources(stage)),
                                       ("storage", reflection.readWriteResources, state.GetReadWriteResources(stage))):
            points = state.GetBindpointMapping(stage)
            points = points.readOnlyResources if kind == "sampled" else points.readWriteResources
            by_point = {}  # OpenGL's atomic counters, buffers and images share numbers: only textures count
            for array in bound:
                if array.resources and int(array.resources[0].resourceId) in self.textures:
                    by_point.setdefault((array.bindPoint.bindset, array.bindPoint.bind), array)
            for resource in resources:
                point = points[resource.bindPoint]
                array = by_point.get((point.bindset, point.bind))
                samplers.append({"name": resource.name, "access": kind,
                                 "texture": self.bound(array.resources[0]) if array else None})
        return {"samplers": samplers, "outputs": [o.varName or o.semanticName for o in reflection.outputSignature],
                "blocks": [self.block(state, stage, reflection, i) for i in range(len(reflection.constantBlocks))]}

    def block(self, state, stage, reflection, slot):
        block = reflection.constantBlocks[slot]
        bound = state.GetConstantBuffer(stage, slot, 0)
        dispatch = stage == self.rd.ShaderStage.Compute
        pipeline = state.GetComputePipelineObject() if dispatch else state.GetGraphicsPipelineObject()
        contents = self.controller.GetCBufferVariableContents(pipeline, reflection.resourceId, stage, state.GetShaderEntryPoint(stage), slot,
                                                              bound.resourceId, bound.byteOffset, bound.byteSize)
        members = []
        for variable in contents:
            self.flatten("", variable, members)
        return {"name": block.name, "members": members}

    def flatten(self, before, variable, members):
        name = before + variable.name
        if len(variable.members):
            for member in variable.members:
                self.flatten(name if member.name.startswith("[") else name + ".", member, members)
            return
        kind = self.variables[variable.type]
        storage = {"Float": "f32v", "Double": "f64v", "SInt": "s32v", "UInt": "u32v", "Bool": "u32v", "Half": "f16v"}.get(kind)
        if storage is None:
            return
        rows, columns = max(int(variable.rows), 1), max(int(variable.columns), 1)
        values = list(getattr(variable.value, storage)[:rows * columns])
        members.append({"name": name, "type": kind, "rows": rows, "columns": columns, "value": values})

    def bound(self, resource):
        texture = self.textures.get(int(resource.resourceId))
        if texture is None:
            return None
        return dict(self.texture(int(resource.resourceId)), mip=max(int(resource.firstMip), 0), slice=max(int(resource.firstSlice), 0))

    def texture(self, identifier):
        texture = self.textures[identifier]
        form = texture.format
        kind = self.types[form.type]
        return {"id": identifier, "name": self.resources.get(identifier, ""), "width": texture.width, "height": texture.height,
                "layers": texture.arraysize, "mips": texture.mips, "samples": texture.msSamp, "cube": bool(texture.cubemap),
                "depth": texture.depth, "format": {"name": str(form.Name()), "type": kind, "components": form.compCount, "bytes": form.compByteWidth,
                                                   "kind": self.kinds[form.compType], "bgra": bool(form.BGRAOrder())}}

    # What an image holds at an event.

    def read(self, event, identifier, mip=0, layer=0):
        """Raw bytes, width and height of one layer of one level, as the image is after the event."""
        self.at(event)
        texture = self.textures[identifier]
        raw = self.controller.GetTextureData(texture.resourceId, self.rd.Subresource(mip, layer, 0))
        width, height = max(texture.width >> mip, 1), max(texture.height >> mip, 1)
        expected = texels.bytes_of_texel(self.texture(identifier)["format"]) * width * height
        if len(raw) < expected:
            raise CaptureError(f"texture {identifier} at event {event}: RenderDoc gave {len(raw)} bytes, expected {expected}")
        return bytes(raw[:expected]), width, height
