"""Lights the patches of a scene by path tracing (Blender's Cycles) and writes them as a PLY.

    radiosity mesh data/cornell-box.obj --patches 500 -o patches.obj
    blender --background --python data/blender_lit.py -- patches.obj data/cornell-box.mtl \
        data/cornell-box-cycles.ply

Made with Blender 3.4.1, 512 paths a sample. Each patch becomes a face with vertices of its own,
coloured with the outgoing radiance (W/m^2/sr, linear, floats) that Cycles bakes at its middle: the
mean over the corners of a tiny square that lies on it, so that no sample falls on an edge.
"""
import struct
import sys

import bpy
import mathutils

SIZE = 2e-3  # of the squares, metres
LIFT = 1e-5  # above the patch


def read_materials(path):
    materials, name = {}, None
    for line in open(path):
        words = line.split()
        if words[:1] == ["newmtl"]:
            name = words[1]
            materials[name] = {"Kd": (0.5,) * 3, "Ke": (0.0,) * 3}
        elif words[:1] in (["Kd"], ["Ke"]):
            materials[name][words[0]] = tuple(map(float, words[1:4]))
    return materials


def read_patches(path):
    vertices, faces, material = [], [], None
    for line in open(path):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["usemtl"]:
            material = words[1]
        elif words[:1] == ["f"]:
            faces.append(([int(w) - 1 for w in words[1:]], material))
    return vertices, faces


def add_material(name, values):
    """Diffuse reflection plus emission, nothing else."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*values["Kd"], 1)
    output = nodes.new("ShaderNodeOutputMaterial")
    shader = diffuse.outputs[0]
    strength = max(values["Ke"])
    if strength > 0:
        lamp = nodes.new("ShaderNodeEmission")
        lamp.inputs["Color"].default_value = (*(k / strength for k in values["Ke"]), 1)
        lamp.inputs["Strength"].default_value = strength
        both = nodes.new("ShaderNodeAddShader")
        links.new(shader, both.inputs[0])
        links.new(lamp.outputs[0], both.inputs[1])
        shader = both.outputs[0]
    links.new(shader, output.inputs["Surface"])
    return made


def add_object(name, vertices, faces, materials):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], [corners for corners, _ in faces])
    slots = list(materials)
    for slot in slots:
        mesh.materials.append(materials[slot])
    for polygon, (_, material) in zip(mesh.polygons, faces):
        polygon.material_index = slots.index(material)
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(thing)
    return thing


def samples_of(vertices, faces):
    """A tiny square on every patch."""
    points, squares = [], []
    for corners, material in faces:
        p = [mathutils.Vector(vertices[c]) for c in corners]
        middle = sum(p, mathutils.Vector()) / len(p)
        normal = mathutils.geometry.normal(p)
        along = (p[1] - p[0]).normalized()
        across = normal.cross(along)
        first = len(points)
        for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            points.append(middle + SIZE / 2 * (u * along + v * across) + LIFT * normal)
        squares.append((list(range(first, first + 4)), material))
    return points, squares


def bake(thing):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = 512
    cycles.use_adaptive_sampling = False
    cycles.max_bounces = cycles.diffuse_bounces = 64
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0, 0, 0)
    scene.render.bake.target = "VERTEX_COLORS"
    colours = thing.data.color_attributes.new("lit", "FLOAT_COLOR", "CORNER")
    thing.data.color_attributes.active_color = colours
    bpy.context.view_layer.objects.active = thing
    thing.select_set(True)
    bpy.ops.object.bake(type="COMBINED")
    flat = [0.0] * (4 * len(thing.data.loops))
    thing.data.color_attributes["lit"].data.foreach_get("color", flat)
    return flat


def write_ply(path, vertices, faces, colours):
    count = sum(len(corners) for corners, _ in faces)
    header = ["ply", "format binary_little_endian 1.0",
              "comment outgoing radiance, W/m^2/sr, linear Rec. 709; Blender 3.4.1, Cycles",
              f"element vertex {count}",
              *(f"property float {name}" for name in ("x", "y", "z", "red", "green", "blue")),
              f"element face {len(faces)}", "property list uchar int vertex_indices",
              "end_header", ""]
    with open(path, "wb") as file:
        file.write("\n".join(header).encode())
        for (corners, _), colour in zip(faces, colours):
            for c in corners:
                file.write(struct.pack("<6f", *vertices[c], *colour))
        first = 0
        for corners, _ in faces:
            file.write(struct.pack(f"<B{len(corners)}i", len(corners),
                                   *range(first, first + len(corners))))
            first += len(corners)


patches_file, materials_file, target = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
vertices, faces = read_patches(patches_file)
materials = {name: add_material(name, values)
             for name, values in read_materials(materials_file).items()}
add_object("scene", vertices, faces, materials)
flat = bake(add_object("samples", *samples_of(vertices, faces), materials))
colours = [[sum(flat[4 * (4 * k + corner) + band] for corner in range(4)) / 4 for band in range(3)]
           for k in range(len(faces))]
write_ply(target, vertices, faces, colours)
print("mean", [sum(c[b] for c in colours) / len(colours) for b in range(3)])
