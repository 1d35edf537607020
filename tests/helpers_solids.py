"""The solids that a view of the page holds."""

from __future__ import annotations

import base64
import re
from typing import Any

import trimesh


def bodies_of(view: str) -> dict[str, Any]:
    """The meshes in a view, by name, where they stand."""
    (data,) = re.findall(r'base64_data="([^"]+)"', view)
    scene: Any = trimesh.load(
        file_obj=trimesh.util.wrap_as_stream(base64.b64decode(data)), file_type="glb"
    )
    found = {}
    for node in sorted(scene.graph.nodes_geometry):
        place, name = scene.graph[node]
        found[name] = scene.geometry[name].copy().apply_transform(place)
    return found
