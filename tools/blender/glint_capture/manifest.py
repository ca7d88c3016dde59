"""Writes the manifest that glint pack reads, and its textures as NumPy files."""
import copy
import json
import os

import numpy as np


class Manifest:
    def __init__(self, folder, name="manifest", prefix=""):
        self.folder, self.name, self.prefix = folder, name, prefix
        os.makedirs(folder, exist_ok=True)
        self.content = {"glint": 1, "frame": {}, "textures": {}, "parts": {}}

    def copy(self, name, prefix):
        """Another manifest of the same textures, whose own ones get a prefix."""
        made = Manifest(self.folder, name, prefix)
        made.content = copy.deepcopy(self.content)
        return made

    def texture(self, name, values):
        np.save(os.path.join(self.folder, name + ".npy"), np.ascontiguousarray(values, np.float32))
        self.content["textures"][name] = {"file": name + ".npy"}

    def part(self, name, channels, **more):
        """channels: letters or a channel's name, and its array."""
        part = dict(more)
        for channel, values in channels.items():
            texture = f"{self.prefix}{name}.{channel}".replace(".", "_")
            self.texture(texture, values)
            part[channel] = texture if values.ndim == 2 else {"texture": texture, "channel": "rgb"[:values.shape[2]]}
        self.content["parts"][name] = part

    def write(self):
        path = os.path.join(self.folder, self.name + ".json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(self.content, file, indent=1)
            file.write("\n")
        return path
