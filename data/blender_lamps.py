"""A room with a sun and two points, built in Blender and exported by its own glTF exporter.

    blender --background --python data/blender_lamps.py -- data/blender-lamps.glb [cycles.exr]

Made with Blender 3.4.1. The sun falls through a window; the second file is the same room as
Blender's Cycles shows it, to compare with: diffuse, 4,096 paths a pixel, radiance in W/(m^2 sr).
"""
import math
import sys

import bpy


def material(name, colour):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Metallic"].default_value = 0
    return made


def walls(name, quads, made):
    """One-sided quads that face into the room."""
    mesh = bpy.data.meshes.new(name)
    vertices = [corner for quad in quads for corner in quad]
    mesh.from_pydata(vertices, [], [tuple(range(4 * k, 4 * k + 4)) for k in range(len(quads))])
    mesh.materials.append(made)
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(thing)


def named(name, made):
    thing = bpy.context.object
    thing.name = name
    thing.data.materials.append(made)


def lamp(name, kind, location, energy, colour):
    data = bpy.data.lights.new(name, kind)
    data.energy = energy
    data.color = colour
    if kind == "SUN":
        data.angle = 0
    else:
        data.shadow_soft_size = 0
    thing = bpy.data.objects.new(name, data)
    thing.location = location
    bpy.context.collection.objects.link(thing)
    return thing


def cycles(path):
    """Diffuse materials alone, and no sky."""
    for made in bpy.data.materials:
        nodes, links = made.node_tree.nodes, made.node_tree.links
        colour = tuple(nodes["Principled BSDF"].inputs["Base Color"].default_value)
        nodes.clear()
        diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
        diffuse.inputs["Color"].default_value = colour
        links.new(diffuse.outputs[0], output.inputs["Surface"])
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 4096
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = 64
    scene.cycles.sample_clamp_indirect = 0
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 1
    scene.render.resolution_x = scene.render.resolution_y = 128
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


bpy.ops.wm.read_factory_settings(use_empty=True)
X, Y, Z = 2.5, 2.0, 2.7  # half a floor, and the height
plaster = material("Plaster", (0.75, 0.73, 0.7))
walls("Floor", [[(-X, -Y, 0), (X, -Y, 0), (X, Y, 0), (-X, Y, 0)]], material("Wood", (0.45, 0.28, 0.15)))
walls("Ceiling", [[(-X, -Y, Z), (-X, Y, Z), (X, Y, Z), (X, -Y, Z)]], plaster)
walls("Walls", [[(-X, Y, 0), (X, Y, 0), (X, Y, Z), (-X, Y, Z)],
                [(X, -Y, 0), (-X, -Y, 0), (-X, -Y, Z), (X, -Y, Z)],
                [(-X, -Y, 0), (-X, Y, 0), (-X, Y, Z), (-X, -Y, Z)]], plaster)
# The window, 1.4 x 1.2 m, between four pieces of the wall at x = X.
walls("Window wall", [[(X, Y, 0), (X, -Y, 0), (X, -Y, 0.9), (X, Y, 0.9)],
                      [(X, Y, 2.1), (X, -Y, 2.1), (X, -Y, Z), (X, Y, Z)],
                      [(X, -0.7, 0.9), (X, -Y, 0.9), (X, -Y, 2.1), (X, -0.7, 2.1)],
                      [(X, Y, 0.9), (X, 0.7, 0.9), (X, 0.7, 2.1), (X, Y, 2.1)]], plaster)
bpy.ops.mesh.primitive_cube_add(size=1, location=(-0.6, 0.6, 0.72))
bpy.context.object.scale = (1.4, 0.8, 0.05)
named("Table", material("Oak", (0.5, 0.35, 0.2)))
for k, (x, y) in enumerate([(-1.2, 0.3), (0, 0.3), (-1.2, 0.9), (0, 0.9)]):
    bpy.ops.mesh.primitive_cube_add(size=1, location=(x, y, 0.345))
    bpy.context.object.scale = (0.06, 0.06, 0.69)
    named(f"Leg {k}", bpy.data.materials["Oak"])
bpy.ops.mesh.primitive_cylinder_add(vertices=32, radius=0.12, depth=0.4, location=(-0.7, 0.6, 0.95))
named("Vase", material("Blue", (0.1, 0.2, 0.55)))
bpy.ops.mesh.primitive_cube_add(size=0.6, location=(-1.7, -0.6, 0.3), rotation=(0, 0, math.radians(25)))
named("Crate", material("Red", (0.6, 0.08, 0.05)))
lamp("Sun", "SUN", (0, 0, 5), 20, (1, 0.95, 0.85)).rotation_euler = (math.radians(10), math.radians(50), 0)
lamp("Ceiling lamp", "POINT", (0.8, -0.4, 2.4), 60, (1, 0.85, 0.7))
lamp("Reading lamp", "POINT", (-1.9, 1.5, 1.2), 15, (1, 0.8, 0.6))
bpy.ops.object.camera_add(location=(1.6, -1.7, 1.6), rotation=(math.radians(78), 0, math.radians(42)))
bpy.context.object.data.angle = math.radians(75)
bpy.context.scene.camera = bpy.context.object
paths = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.export_scene.gltf(filepath=paths[0], export_format="GLB", export_cameras=True, export_lights=True,
                          export_apply=True)
if len(paths) > 1:
    cycles(paths[1])
