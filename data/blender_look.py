"""Imports a lit GLB into Blender and renders what a user would see there.

    build/release/radiosity solve data/cornell-box.obj --patches 300 -o data/cornell-box-lit.glb
    blender --background --python data/blender_look.py -- data/cornell-box-lit.glb /tmp/look.png

`cornell-box-lit.glb` beside this file was made so. The camera is the Cornell box's own, in Blender's
z-up axes. The colours must look as in the program's PNG: they are unlit and need no lamp.
"""
import math
import sys

import bpy
import numpy

if not hasattr(numpy, "bool"):  # Debian 12's importer still uses the name that numpy 1.24 dropped
    numpy.bool = bool

source, picture = sys.argv[-2:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=source)
scene = bpy.context.scene
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(camera)
camera.location = (0.278, 0.8, 0.273)
camera.rotation_euler = (math.pi / 2, 0, math.pi)
camera.data.angle = 2 * math.atan(12.5 / 35)
scene.camera = camera
scene.render.engine = "CYCLES"
scene.cycles.samples = 16
scene.cycles.use_denoising = False
scene.view_settings.view_transform = "Standard"
scene.render.resolution_x = scene.render.resolution_y = 400
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
