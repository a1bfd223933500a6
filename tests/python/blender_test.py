"""What Blender's own library (bpy) makes of a cache with examples/blender/load_motion.py, number by number.

python blender_test.py ROOT PROGRAM
"""

from __future__ import annotations

import pathlib
import struct
import subprocess
import sys
import tempfile

import bpy
import numpy as np

root, program = sys.argv[1:]
sys.path.insert(0, str(pathlib.Path(root) / "examples/blender"))
import load_motion  # noqa: E402

SCENES = {
    "cube": ["cube-plane", "--set", "cube[0].particles-per-edge=4", "--set", "cube[0].position=[0,2.2,0]"],
    "net": ["penalty"],
    "figure": ["jelly-figure", "--set", "voxels[0].cells=10"],
    "cells": ["bridge"],
}

for name, words in SCENES.items():
    with tempfile.TemporaryDirectory() as folder:
        cache = f"{folder}/{name}.pc2"
        steps = ["--backend", "reference", "--steps", "200", "--export", cache, "--export-every", "20"]
        subprocess.run([program, "run", *words, *steps], check=True, stdout=subprocess.DEVNULL)
        with open(cache, "rb") as file:
            _, _, vertices, _, _, samples = struct.unpack("<12siiffi", file.read(32))
            places = np.frombuffer(file.read(), "<f4").reshape(samples, vertices, 3)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = bpy.context.scene
        interval = load_motion.Shape(f"{folder}/{name}.obj").said["interval"]
        # A frame for each sample.
        thing = load_motion.load(cache, speed=interval * scene.render.fps)
        assert samples == 11 and scene.frame_end == scene.frame_start + samples - 1, (samples, scene.frame_end)
        assert len(thing.data.vertices) == vertices and len(thing.vertex_groups) >= 1
        for sample in range(samples):
            scene.frame_set(scene.frame_start + sample)
            shown = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
            found = np.empty(3 * vertices, np.float32)
            shown.to_mesh().vertices.foreach_get("co", found)
            found = found.reshape(-1, 3)
            # Blender mixes two samples with weights of single precision; at the second of them with one of nearly 0.
            bound = 4 * np.finfo(np.float32).eps * np.abs(places).max()
            apart = np.abs(found - places[sample]).max()
            assert apart <= bound, (name, sample, apart, bound)
        # y of Aspic is up, which is z in Blender.
        up = np.array(shown.matrix_world)[:3, :3] @ [0, 1, 0]
        assert np.abs(up - [0, 0, 1]).max() < 1e-6
        print(f"{name}: Blender {bpy.app.version_string} shows {samples} samples of {vertices} vertices")
