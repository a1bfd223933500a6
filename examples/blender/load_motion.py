"""Loads a motion that Aspic exported for Blender (run.pc2 with run.obj next to it) into Blender 3.3 or later.

    aspic run cube-plane --export run.pc2
    blender --python examples/blender/load_motion.py -- run.pc2
    blender --background --python examples/blender/load_motion.py -- run.pc2 --save run.blend

The mesh has a vertex group for each body and ball, and a modifier Mesh Cache that moves it in the scene's frames per
second, as fast as it was simulated. `--speed 0.5` shows half a simulated second in a second.
"""

from __future__ import annotations

import argparse
import math
import os
import sys

import bpy


class Shape:
    """An OBJ file of Aspic: vertices, faces and edges by group, and what its comments say."""

    def __init__(self, path: str):
        self.vertices: list[tuple[float, ...]] = []
        self.faces: list[tuple[int, ...]] = []
        self.edges: list[tuple[int, ...]] = []
        self.groups: dict[str, set[int]] = {}
        self.said: dict[str, float] = {}
        group = ""
        with open(path, encoding="utf-8") as file:
            for line in file:
                kind, *words = line.split() or [""]
                if kind == "v":
                    self.vertices.append(tuple(map(float, words)))
                elif kind == "g":
                    group = words[0]
                elif kind in ("f", "l"):
                    corners = tuple(int(word) - 1 for word in words)
                    (self.faces if kind == "f" else self.edges).append(corners)
                    self.groups.setdefault(group, set()).update(corners)
                elif kind == "#" and len(words) == 2 and words[0] in ("samples", "start", "interval"):
                    self.said[words[0]] = float(words[1])


def load(path: str, speed: float = 1.0) -> bpy.types.Object:
    """The object of a cache, in the scene at hand, with its frames."""
    cache = os.path.abspath(path)
    shape = Shape(os.path.splitext(cache)[0] + ".obj")
    name = os.path.splitext(os.path.basename(cache))[0]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(shape.vertices, shape.edges, shape.faces)
    mesh.update()
    thing = bpy.data.objects.new(name, mesh)
    # Aspic's y is up, Blender's z.
    thing.rotation_euler = (math.pi / 2, 0.0, 0.0)
    for group, vertices in shape.groups.items():
        thing.vertex_groups.new(name=group).add(sorted(vertices), 1.0, "REPLACE")
    bpy.context.scene.collection.objects.link(thing)

    scene = bpy.context.scene
    fps = scene.render.fps / scene.render.fps_base
    motion = thing.modifiers.new("motion", "MESH_CACHE")
    motion.cache_format = "PC2"
    motion.filepath = cache
    motion.interpolation = "LINEAR"
    motion.time_mode = "FRAME"
    motion.play_mode = "SCENE"
    motion.frame_start = scene.frame_start
    interval = shape.said["interval"]
    if interval > 0:
        motion.frame_scale = speed / (interval * fps)
        frames = (shape.said["samples"] - 1) * interval * fps / speed
        scene.frame_end = scene.frame_start + math.ceil(frames - 1e-6)  # rounding adds no frame
    return thing


def main(words: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="load_motion.py", description="Loads a motion of Aspic.")
    parser.add_argument("cache", help="the file .pc2")
    parser.add_argument("--speed", type=float, default=1.0, help="simulated seconds per second shown")
    parser.add_argument("--save", help="a .blend file to write")
    given = parser.parse_args(words)
    thing = load(given.cache, given.speed)
    print(f"{thing.name}: {len(thing.data.vertices)} vertices, frames to {bpy.context.scene.frame_end}")
    if given.save:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(given.save))


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else ["--help"])
