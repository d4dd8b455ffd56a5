"""A small room built in Blender and exported by its own glTF exporter: what other programs write.

    blender --background --python data/blender_room.py -- data/blender-room.glb

Made with Blender 3.4.1. It has what Blender files have: z up turned to y up, materials without
"doubleSided" switched off (Blender marks all two-sided), emission with a strength, a camera under a
node transform, an object without material, a scaled and turned object, an n-gon.
"""
import math
import sys

import bpy


def material(name, colour, emission=None, strength=1.0):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Metallic"].default_value = 0
    if emission:
        shader.inputs["Emission"].default_value = (*emission, 1)
        shader.inputs["Emission Strength"].default_value = strength
    return made


def finish(name, made):
    thing = bpy.context.object
    thing.name = name
    if made:
        thing.data.materials.append(made)
    return thing


bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 1.25))
room = finish("Room", material("Plaster", (0.7, 0.7, 0.7)))
room.scale = (4, 3, 2.5)
bpy.ops.mesh.primitive_cube_add(size=0.8, location=(-0.9, 0.4, 0.4), rotation=(0, 0, math.radians(17)))
finish("Crate", material("Red paint", (0.6, 0.06, 0.04)))
bpy.ops.mesh.primitive_cylinder_add(vertices=24, radius=0.35, depth=1.2, location=(0.9, 0.5, 0.6))
finish("Drum", material("Blue paint", (0.05, 0.12, 0.5)))
bpy.ops.mesh.primitive_plane_add(size=1, location=(0, 0, 2.45), rotation=(math.pi, 0, 0))
finish("Lamp", material("Light", (0.8, 0.8, 0.8), (1.0, 0.9, 0.7), 20.0))
bpy.ops.mesh.primitive_plane_add(size=0.9, location=(0.1, 1.2, 0.9), rotation=(math.radians(80), 0, 0))
finish("Board", None)
bpy.ops.object.camera_add(location=(0.4, -1.4, 1.5), rotation=(math.radians(80), 0, math.radians(5)))
bpy.context.object.data.angle = math.radians(75)
bpy.context.scene.camera = bpy.context.object
bpy.ops.export_scene.gltf(filepath=sys.argv[sys.argv.index("--") + 1], export_format="GLB",
                          export_cameras=True, export_apply=True)
