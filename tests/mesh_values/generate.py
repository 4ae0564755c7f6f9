"""Writes the files of this folder with programs that know nothing of etalon: meshio, trimesh, vtk, pygltflib, OpenEXR.

    python3 -m venv v && v/bin/pip install meshio trimesh vtk pygltflib OpenEXR && v/bin/python generate.py

The mesh: two triangles of the unit square and a quadrilateral beside it, z = 0.25. Values per face f:
r = 1.5 + f, g = 0.1 (f + 1), b = 0.001 f. Values per vertex: r = 1 + x + 2 y, g = 3 - x, b = 0.25 + y / 2.
"""

import base64
import pathlib
import struct

import meshio
import numpy as np
import OpenEXR
import pygltflib as gl
import trimesh

HERE = pathlib.Path(__file__).parent
POINTS = np.array([[0, 0, 0.25], [1, 0, 0.25], [1, 1, 0.25], [0, 1, 0.25], [2, 0, 0.25], [2, 1, 0.25]], float)
TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]])
QUADS = np.array([[1, 4, 5, 2]])
SPLIT = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])
F = np.arange(3.0)
FACE = np.stack([1.5 + F, 0.1 * (F + 1), 0.001 * F], axis=1)
X, Y = POINTS[:, 0], POINTS[:, 1]
VERTEX = np.stack([1 + X + 2 * Y, 3 - X, 0.25 + Y / 2], axis=1)


def vtu():
    cells = [("triangle", TRIANGLES), ("quad", QUADS)]
    by_cells = [FACE[:2], FACE[2:]]
    per_cell = meshio.Mesh(POINTS, cells, cell_data={"radiosity": by_cells, "part": [[7, 7], [8]]})
    per_point = meshio.Mesh(POINTS, cells, point_data={"B": VERTEX[:, 0], "temperature": VERTEX[:, 1]})
    per_cell.write(HERE / "cell_ascii.vtu", binary=False)
    per_cell.write(HERE / "cell_inline.vtu", compression=None)
    per_cell.write(HERE / "cell_zlib.vtu", compression="zlib")
    per_point.write(HERE / "point_zlib.vtu", compression="zlib")


def vtu_by_vtk():
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk

    grid = vtk.vtkUnstructuredGrid()
    points = vtk.vtkPoints()
    points.SetDataTypeToFloat()
    # A strip, a pixel, a polygon of five corners, and a line that does not count.
    for p in [(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (2, 0, 0), (2, 1, 0), (3, 0, 0), (3, 1, 0), (3.5, 0.5, 0)]:
        points.InsertNextPoint(*p)
    grid.SetPoints(points)
    for kind, ids in [
        (vtk.VTK_TRIANGLE_STRIP, [1, 0, 3, 2]),
        (vtk.VTK_PIXEL, [2, 4, 3, 5]),
        (vtk.VTK_LINE, [0, 1]),
        (vtk.VTK_POLYGON, [4, 6, 8, 7, 5]),
    ]:
        grid.InsertNextCell(kind, len(ids), ids)
    for name, values in [("r", [1, 2, 9, 3]), ("g", [0.5, 0.25, 9, 0.125]), ("b", [4, 5, 9, 6])]:
        array = numpy_to_vtk(np.array(values, np.float32), deep=True)
        array.SetName(name)
        grid.GetCellData().AddArray(array)
    for name, mode, encode, order, wide, packed in [
        ("vtk_raw", "Appended", False, "little", True, True),
        ("vtk_base64", "Appended", True, "little", False, True),
        ("vtk_plain", "Appended", False, "big", False, False),
        ("vtk_big", "Binary", True, "big", True, True),
        ("vtk_ascii", "Ascii", True, "little", False, False),
    ]:
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetFileName(str(HERE / f"{name}.vtu"))
        writer.SetInputData(grid)
        getattr(writer, f"SetDataModeTo{mode}")()
        writer.SetEncodeAppendedData(encode)
        writer.SetByteOrderToBigEndian() if order == "big" else writer.SetByteOrderToLittleEndian()
        writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
        writer.SetCompressorTypeToZLib() if packed else writer.SetCompressorTypeToNone()
        writer.Write()


def ply():
    meshio.Mesh(POINTS, [("triangle", SPLIT)], point_data={"red": VERTEX[:, 0], "green": VERTEX[:, 1], "blue": VERTEX[:, 2]}).write(
        HERE / "vertex.ply", binary=True
    )
    mesh = trimesh.Trimesh(POINTS, SPLIT, process=False)
    mesh.visual.vertex_colors = np.array([[0, 51, 255, 255], [51, 51, 255, 255], [102, 51, 255, 255], [153, 51, 255, 255], [204, 51, 255, 255], [255, 51, 255, 255]], np.uint8)
    (HERE / "bytes.ply").write_bytes(mesh.export(file_type="ply"))
    (HERE / "bytes.glb").write_bytes(mesh.export(file_type="glb"))
    # Faces, big endian, floats beside bytes of the same colours.
    head = "ply\nformat binary_big_endian 1.0\nelement vertex 6\nproperty double x\nproperty double y\nproperty double z\n"
    head += "element face 3\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
    head += "property float r\nproperty float g\nproperty float b\nend_header\n"
    out = head.encode() + POINTS.astype(">f8").tobytes()
    for f, face in enumerate([*TRIANGLES, *QUADS]):
        out += bytes([len(face)]) + np.array(face, ">i4").tobytes() + bytes([10, 20, 30]) + FACE[f].astype(">f4").tobytes()
    (HERE / "face_big.ply").write_bytes(out)


def gltf():
    """y is up: the mesh stands upright in the file and lies flat once it is turned."""
    turned = np.stack([POINTS[:, 0], POINTS[:, 2], -POINTS[:, 1]], axis=1).astype("<f4")
    uv = np.stack([X / 2, 1 - Y], axis=1).astype("<f4")
    parts = [SPLIT.astype("<u2").tobytes(), turned.tobytes(), VERTEX.astype("<f4").tobytes(), uv.tobytes()]
    blob = b"".join(parts)
    at = np.cumsum([0] + [len(p) for p in parts])
    views = [gl.BufferView(buffer=0, byteOffset=int(at[k]), byteLength=len(p)) for k, p in enumerate(parts)]
    accessors = [gl.Accessor(bufferView=0, componentType=5123, count=12, type="SCALAR")]
    accessors += [gl.Accessor(bufferView=1, componentType=5126, count=6, type="VEC3", min=[0, 0.25, -1], max=[2, 0.25, 0])]
    accessors += [gl.Accessor(bufferView=2, componentType=5126, count=6, type="VEC3")]
    accessors += [gl.Accessor(bufferView=3, componentType=5126, count=6, type="VEC2")]
    attributes = gl.Attributes(POSITION=1, COLOR_0=2, TEXCOORD_0=3)
    uri = "data:application/octet-stream;base64," + base64.b64encode(blob).decode()
    document = gl.GLTF2(
        asset=gl.Asset(version="2.0"), scene=0, scenes=[gl.Scene(nodes=[0])], nodes=[gl.Node(mesh=0)],
        meshes=[gl.Mesh(primitives=[gl.Primitive(attributes=attributes, indices=0)])],
        accessors=accessors, bufferViews=views, buffers=[gl.Buffer(uri=uri, byteLength=len(blob))],
    )
    document.save_json(HERE / "floats.gltf")


def obj():
    lines = [f"v {x} {y} {z} {r} {g} {b}" for (x, y, z), (r, g, b) in zip(POINTS, VERTEX)]
    lines += [f"vt {x / 2} {y}" for x, y in zip(X, Y)]
    lines += ["f 1/1 2/2 3/3", "f 1/1 3/3 4/4", "f 2/2 5/5 6/6 3/3"]
    (HERE / "mesh.obj").write_text("\n".join(lines) + "\n")
    rows = [f"{f},{r!r},{g!r},{b!r}" for f, (r, g, b) in reversed(list(enumerate(FACE.tolist())))]
    (HERE / "faces.csv").write_text("face,r,g,b\n" + "\n".join(rows) + "\n")
    rows = [f"{v},{r!r},{r / 100!r}" for v, (r, g, b) in enumerate(VERTEX.tolist())]
    (HERE / "vertices.csv").write_text("vertex,y,y_std_err\n" + "\n".join(rows) + "\n")


def exr():
    """4 x 3 texels over the whole mesh, the top row first: R = column, G = row, B = 0.5; one texel empty."""
    column, row = np.meshgrid(np.arange(4, dtype=np.float32), np.arange(3, dtype=np.float32))
    alpha = np.ones((3, 4), np.float32)
    alpha[0, 3] = 0
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    channels = {"R": column, "G": row, "B": np.full((3, 4), 0.5, np.float32), "A": alpha}
    with OpenEXR.File(header, channels) as file:
        file.write(str(HERE / "map.exr"))
    with OpenEXR.File(header, {"Y": (column + 10 * row).astype(np.float16)}) as file:
        file.write(str(HERE / "grey.exr"))


if __name__ == "__main__":
    for write in (vtu, vtu_by_vtk, ply, gltf, obj, exr):
        write()
