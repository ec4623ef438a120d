"""Blender opens the animations: run where its Python module is installed (pip install bpy)."""

import json
import subprocess
import sys
from importlib.util import find_spec

import numpy as np
import pytest

from exactfold import random_square
from exactfold.branches import find_branch
from exactfold.motion import follow, write_motion

SHOWN = """
import json, sys
import bpy

bpy.ops.wm.read_factory_settings(use_empty=True)
assert bpy.ops.import_scene.gltf(filepath=sys.argv[1]) == {"FINISHED"}
[sheet] = bpy.data.objects
scene = bpy.context.scene
found = []
for time in json.loads(sys.argv[2]):
    frame = time * scene.render.fps / scene.render.fps_base
    scene.frame_set(int(frame), subframe=frame % 1)
    there = sheet.evaluated_get(bpy.context.evaluated_depsgraph_get())
    points = [there.matrix_world @ v.co for v in there.data.vertices]
    faces = [[list(points[v]) for v in face.vertices] for face in there.data.polygons]
    found.append(faces)
names = [slot.material.name for slot in sheet.material_slots]
shown = {"name": sheet.name, "materials": names, "faces": found}
print("SHOWN" + json.dumps(shown))
"""


@pytest.mark.slow
@pytest.mark.skipif(find_spec("bpy") is None, reason="needs Blender's module bpy")
def test_blender_shows_the_frames(tmp_path):
    """At the time of each frame the faces have the places of the motion, on both sides."""
    pattern = random_square(4, seed=1)
    motion = follow(find_branch(pattern, "+-++"), frames=6)
    path = tmp_path / "motion.glb"
    write_motion(motion, path, title="sheet")
    times = [0.8 * k for k in range(11)]  # there and back
    process = subprocess.run(
        [sys.executable, "-c", SHOWN, str(path), json.dumps(times)],
        capture_output=True,
        text=True,
        check=True,
    )
    [line] = [line for line in process.stdout.splitlines() if line.startswith("SHOWN")]
    shown = json.loads(line.removeprefix("SHOWN"))
    assert shown["name"] == "sheet"
    assert shown["materials"] == ["front", "back"]
    triangles = np.array(pattern.triangles)
    for key, faces in enumerate(shown["faces"]):
        front, back = np.array(faces).reshape(2, len(triangles), 3, 3)
        corners = motion.coords[min(key, 10 - key)][triangles]
        assert front == pytest.approx(corners, abs=1e-5)
        assert sorted(map(tuple, back.reshape(-1, 3).round(4))) == sorted(
            map(tuple, front.reshape(-1, 3).round(4))
        )
        across = [
            np.cross(side[:, 1] - side[:, 0], side[:, 2] - side[:, 0]) for side in (front, back)
        ]
        assert across[0] == pytest.approx(-across[1], abs=1e-5)
