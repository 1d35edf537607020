"""Mesh files: STL (binary), 3MF and GLB, the latter two by trimesh, and trimesh's view of them.

All three are in the unit of files (`gearcam.base.inches.file_unit`). STL has none, and says it in
its header; 3MF states it; the unit of glTF is the metre, but CAD programs read the plain numbers,
so the GLB keeps the unit of files and notes it in its scene's extras (``"units": "mm"``). STL and
GLB have single precision: vertices are rounded first and coincident ones are joined, so that the
file is closed as written. The same mesh gives the same bytes.

Refused: meshes that are not closed, before or after rounding.

Depends on solids; trimesh (with networkx and lxml for 3MF) only inside the functions.
"""

from __future__ import annotations

import io
import re
import uuid
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.inches import file_unit
from gearcam.numeric.mesh import Mesh
from gearcam.parts.solids import SolidError, libraries

if TYPE_CHECKING:
    from trimesh import Scene, Trimesh

    from gearcam.numeric.pose import SpacePose

HEADER_LENGTH: Final = 80
"""Bytes of an STL header."""

TRIANGLE: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("color", "<u2")])
"""A triangle of a binary STL; their number follows the header, in four bytes."""

EPOCH: Final = (1980, 1, 1, 0, 0, 0)
"""The date in a 3MF's archive: the earliest of the format."""

_UUID: Final = re.compile(rb"[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}")


def stl_bytes(bodies: Mapping[str, Mesh], name: str) -> bytes:
    """Return a binary STL with the name in the header, and the bodies in order.

    Parameters
    ----------
    bodies : mapping of str to Mesh
        Closed, in the unit of files, by name.
    name : str
        The name of the part or assembly.

    Returns
    -------
    bytes

    Raises
    ------
    SolidError
        If the mesh is not closed, or rounding to single precision opens it.
    """
    # each body separately: joined, two that touch would share edges and be open
    single = [_single(mesh, body) for body, mesh in bodies.items()]
    corners = np.concatenate([mesh.vertices[mesh.triangles] for mesh in single])
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sizes = np.linalg.norm(normals, axis=1, keepdims=True)
    triangles = np.zeros(len(corners), dtype=TRIANGLE)
    triangles["corners"] = corners
    triangles["normal"] = np.divide(normals, sizes, out=normals, where=sizes > 0.0)
    # "solid" at the start would mean the text format
    label = f"gearcam {name} ({file_unit().name})".encode("ascii", "replace")[:HEADER_LENGTH]
    count = len(triangles).to_bytes(4, "little")
    return label.ljust(HEADER_LENGTH, b"\0") + count + triangles.tobytes()


@libraries()
def threemf_bytes(bodies: Mapping[str, Mesh], name: str) -> bytes:
    """Return a 3MF; each body is an object of its name (see `stl_bytes`)."""
    from trimesh.exchange.threemf import export_3MF

    return _repeatable(export_3MF(_scene(bodies, single=False)), name)


@libraries()
def glb_bytes(bodies: Mapping[str, Mesh], name: str) -> bytes:
    """Return a GLB; each body is a node and mesh of its name (see `stl_bytes`)."""
    from trimesh.exchange.gltf import export_glb

    scene = _scene(bodies)
    scene.metadata |= {"units": file_unit().name, "name": name}
    return bytes(export_glb(scene, include_normals=False))


def mesh_bytes(kind: str, bodies: Mapping[str, Mesh], name: str) -> bytes:
    """Return closed bodies as a file of a format (see `stl_bytes`).

    Parameters
    ----------
    kind : str
        The format, one of `gearcam.designs.outputs.MESHES`.
    bodies : mapping of str to Mesh
        Closed, mm, by name.
    name : str
        The name of the part or assembly.

    Returns
    -------
    bytes
    """
    writers = {"stl": stl_bytes, "3mf": threemf_bytes, "glb": glb_bytes}
    size = file_unit().size
    sized = {one: replace(mesh, vertices=mesh.vertices / size) for one, mesh in bodies.items()}
    return writers[kind](bodies if size == 1.0 else sized, name)


@libraries()
def view_page(bodies: Mapping[str, tuple[Mesh, SpacePose]]) -> str:
    """Return trimesh's page to turn and zoom closed bodies (see `stl_bytes`) in their places.

    It contains the bodies and all its scripts: it needs a browser with WebGL, but no network. Each
    body is an object of its name that can be moved: its points are those of its own frame.
    """
    from trimesh.scene import Camera
    from trimesh.viewer.notebook import scene_to_html

    scene = _scene({name: mesh for name, (mesh, _) in bodies.items()})
    for name, (_, pose) in bodies.items():
        scene.graph.update(name, matrix=pose.matrix)
    scene.camera = Camera(name="camera", fov=(60.0, 45.0))  # a generated one has a random name
    scene.set_camera()
    return scene_to_html(scene)


@libraries()
def trimeshes(bodies: Mapping[str, Mesh]) -> dict[str, Trimesh]:
    """Return closed bodies as meshes of trimesh, mm, by name (see `stl_bytes`)."""
    from trimesh import Trimesh

    for name, mesh in bodies.items():
        _require(mesh, name)
    return {
        name: Trimesh(
            vertices=mesh.vertices, faces=mesh.triangles, process=False, metadata={"name": name}
        )
        for name, mesh in bodies.items()
    }


def _scene(bodies: Mapping[str, Mesh], *, single: bool = True) -> Scene:
    """Return closed bodies, in single or in double precision."""
    from trimesh import Scene

    if single:
        bodies = {name: _single(mesh, name) for name, mesh in bodies.items()}
    scene = Scene()
    for name, body in trimeshes(bodies).items():
        scene.add_geometry(body, node_name=name, geom_name=name)
    return scene


def _require(mesh: Mesh, name: str, when: str = "") -> None:
    if not (mesh.watertight and mesh.volume > 0):
        raise SolidError(f"{name}: the mesh is not closed{when}")


def _single(mesh: Mesh, name: str) -> Mesh:
    """Return a mesh in single precision, coincident points joined, folded triangles dropped."""
    _require(mesh, name)
    rounded = mesh.vertices.astype(np.float32).astype(np.float64)
    order = np.lexsort(rounded.T)
    new = np.append(True, (np.diff(rounded[order], axis=0) != 0.0).any(axis=1))
    index = np.empty_like(order)
    index[order] = np.cumsum(new) - 1
    single = mesh.joined(index, rounded[order[new]])
    _require(single, name, " in single precision")
    return single


def _repeatable(data: bytes, name: str) -> bytes:
    """Return a 3MF archive with fixed identifiers and dates instead of random ones."""
    result, unit = io.BytesIO(), "millimeter" if file_unit().size == 1.0 else "inch"
    with (
        zipfile.ZipFile(io.BytesIO(data)) as source,
        zipfile.ZipFile(result, "w", zipfile.ZIP_DEFLATED) as target,
    ):
        for entry in source.infolist():
            count = iter(range(1 << 30))

            def fixed(_: re.Match[bytes], count=count) -> bytes:
                return str(uuid.uuid5(uuid.NAMESPACE_OID, f"gearcam/{name}/{next(count)}")).encode()

            content = _UUID.sub(fixed, source.read(entry))
            content = content.replace(b'unit="millimeter"', f'unit="{unit}"'.encode(), 1)
            target.writestr(zipfile.ZipInfo(entry.filename, EPOCH), content, zipfile.ZIP_DEFLATED)
    return result.getvalue()
