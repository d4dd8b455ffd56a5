"""Files that are broken, forged or far too large: one clear line each, in bounded time and memory,
without messages of the libraries."""

import json
import os
import resource
import struct
import subprocess
import sys
import unittest

import h5py
import numpy

import input_files
from cli_runner import DATA, PROGRAM, SMALL, CliTest

# Seconds of processor time. Refusing a file takes hundredths, reading one a few: work that grows
# with the square of a file's size takes minutes.
MOST_SECONDS = 60
# Bytes of address space: the program with its libraries takes less than a tenth of it.
MOST_BYTES = 4 << 30


def limited():
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS, MOST_SECONDS))
    resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))


class FileTest(CliTest):
    def put(self, name, content):
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def put_triangle(self, change=None, data=None):
        document = input_files.triangle()
        if change:
            change(document)
        return self.put("a.glb", input_files.glb(document, data or input_files.triangle_data()))

    def run_limited(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True,
                              timeout=600, check=False, preexec_fn=limited)

    def says(self, line, *arguments, code=2):
        """The run must fail with exactly this line."""
        run = self.run_limited(*arguments)
        self.assertEqual(run.stderr.decode(), f"radiosity: {line}\n")
        self.assertEqual(run.returncode, code)

    def passes(self, *arguments):
        run = self.run_limited(*arguments)
        self.assertEqual(run.returncode, 0, run.stderr.decode())
        return run.stdout.decode() + run.stderr.decode()


class Json(FileTest):
    DEEP = "its JSON is nested more than 200 levels deep; export it again"

    def test_deep_nesting_in_a_glb_is_refused(self):
        for name in ["extras", "extensions", "nodes"]:
            for opening, closing in ["[]", ('{"a":', "}")]:
                value = opening * 100000 + "0" + closing * 100000
                text = f'{{"asset": {{"version": "2.0"}}, "{name}": {value}}}'
                with self.subTest(name=name, opening=opening):
                    self.put("a.glb", input_files.glb(None, text=text))
                    self.says("a.glb: " + self.DEEP, "info", "a.glb")

    def test_deep_nesting_in_a_materials_file_is_refused(self):
        self.put("m.json", "[" * 100000)
        self.says("m.json: is not a JSON object; write {\"NAME\": {\"reflectance\": 0.5}}", "info",
                  "box.obj", "--materials", "m.json")

    def test_a_long_chain_of_nodes_is_read(self):
        def chain(document):
            count = 100000
            document["nodes"] = [{"children": [k + 1]} for k in range(count)] + [{"mesh": 0}]
        self.assertIn("faces                            1\n", self.passes("info", self.put_triangle(chain)))

    def test_a_number_beyond_double_precision_is_refused(self):
        text = json.dumps(input_files.triangle()).replace('"count": 3', '"count": 1e999', 1)
        self.put("a.glb", input_files.glb(None, input_files.triangle_data(), text))
        line = self.refuse("info", "a.glb", words=["a number is too large at byte"])
        self.assertNotIn("json.exception", line)

    def test_a_truncated_file_is_refused(self):
        self.put("a.gltf", '{"asset": {"version": "2.0')
        self.says("a.gltf: is not JSON that can be read: it is cut off or damaged at byte 27 (after "
                  "`t\": {\"version\": \"2.0`); export it again", "info", "a.gltf")

    def test_a_large_materials_file_is_read(self):
        entries = {f"name{k}": {"reflectance": 0.5} for k in range(200000)}
        self.put("m.json", json.dumps(entries))
        self.refuse("info", "box.obj", "--materials", "m.json", words=["name0", "there are: lamp, "])
        objects = "".join(f"o part{k}\nusemtl wall\nf 1 2 3\n" for k in range(20000))
        self.put("many.obj", "mtllib box.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n" + objects)
        self.put("m.json", json.dumps({f"part{k}": {"reflectance": k / 20000} for k in range(20000)}))
        self.passes("info", "many.obj", "--materials", "m.json")


class Gltf(FileTest):
    def test_a_damaged_container_is_refused(self):
        whole = input_files.glb(input_files.triangle(), input_files.triangle_data())
        self.put("a.glb", whole[:-8])
        self.says(f"a.glb: the file is cut off: it has {len(whole) - 8} of {len(whole)} bytes; export "
                  "the scene again", "info", "a.glb")
        self.put("a.glb", whole[:12] + struct.pack("<I", 2**31) + whole[16:])
        self.says("a.glb: the chunk at byte 12 reaches beyond the end of the file; export the scene "
                  "again", "info", "a.glb")
        self.put("a.glb", b"glTF")
        self.says("a.glb: the file is cut off within its header; export the scene again", "info",
                  "a.glb")
        self.put("a.glb", "hello")
        self.refuse("info", "a.glb", words=["a.glb: is neither binary glTF nor a JSON object"])

    def test_accessors_without_data_are_refused(self):
        def forge(document):
            document["accessors"][0] = {"componentType": 5126, "count": 2**28, "type": "VEC3"}
        self.says("a.glb: plate, primitive 0: POSITION has no data (no buffer view); export the scene "
                  "again, without compression", "info", self.put_triangle(forge))

        def forge_sparse(document):
            forge(document)
            document["accessors"][0]["sparse"] = {
                "count": 1, "indices": {"bufferView": 1, "componentType": 5123},
                "values": {"bufferView": 0}}
        self.says("a.glb: plate, primitive 0: POSITION claims 268435456 elements, more than the 68 "
                  "bytes of all buffers; export the scene again", "info",
                  self.put_triangle(forge_sparse))

    def test_impossible_buffer_sizes_are_refused(self):
        for size in [0, 2**62]:
            def forge(document):
                document["buffers"][0]["byteLength"] = size
            with self.subTest(size=size):
                line = self.refuse("info", self.put_triangle(forge), words=["a.glb: "])
                for word in ["_M_", "std::", "memory"]:
                    self.assertNotIn(word, line)

    def test_unsupported_required_extensions_are_named(self):
        def needs(*names):
            def change(document):
                document["extensionsRequired"] = list(names)
            return self.put_triangle(change)
        self.says("a.glb: needs EXT_a, which is not supported; export without it", "info",
                  needs("EXT_a"))
        self.says("a.glb: needs KHR_a, KHR_b, which are not supported; export without them", "info",
                  needs("KHR_a", "KHR_mesh_quantization", "KHR_b"))

    def test_a_missing_buffer_file_is_named(self):
        document = input_files.triangle()
        document["buffers"][0]["uri"] = "plate.bin"
        self.put("a.gltf", json.dumps(document))
        self.says("a.gltf: its buffer file plate.bin: no such file; check the name and the folder",
                  "info", "a.gltf")
        self.put("plate.bin", b"short")
        self.says("a.gltf: its buffer file plate.bin, requestedBytes 68, but got 5; export the "
                  "scene again with it", "info", "a.gltf")
        self.put("plate.bin", input_files.triangle_data())
        self.passes("info", "a.gltf")


class NotFiles(FileTest):
    PIPE = "is a pipe or a device, not a file; copy what it holds into a file first"
    FOLDER = "is a folder; name a file in it"

    def named(self, name):
        """The name as a pipe without a writer, as an endless device, as a folder."""
        path = self.folder / name
        os.mkfifo(path)
        yield self.PIPE
        path.unlink()
        path.symlink_to("/dev/zero")
        yield self.PIPE
        path.unlink()
        path.mkdir()
        yield self.FOLDER
        path.rmdir()

    def test_scene_and_results_files_must_be_files(self):
        for name in ["a.obj", "a.glb", "a.gltf", "a.stl", "a.h5"]:
            for what in self.named(name):
                self.says(f"{name}: {what}", "info", name)

    def test_sides_of_a_comparison_must_be_files(self):
        self.put("b.ply", input_files.PLY)
        for name in ["a.ply", "a.glb", "a.obj", "a.png", "a.h5"]:
            for what in self.named(name):
                self.says(f"{name}: {what}", "compare", name, "b.ply")

    def test_files_beside_the_scene_must_be_files(self):
        document = input_files.triangle()
        document["buffers"][0]["uri"] = "plate.bin"
        self.put("a.gltf", json.dumps(document))
        for what in self.named("plate.bin"):
            self.says(f"a.gltf: its buffer file plate.bin: {what}", "info", "a.gltf")
        for what in self.named("m.json"):
            self.says(f"m.json: {what}", "info", "box.obj", "--materials", "m.json")
        self.put("b.obj", "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n")
        for what in self.named("b.mtl"):
            self.assertIn(f"material file b.mtl: {what}", self.passes("info", "b.obj"))
        self.put("b.mtl", "newmtl m\nmap_Kd t.png\n")
        for what in self.named("t.png"):
            self.assertIn(f"texture t.png {what}", self.passes("info", "b.obj"))

    def test_an_output_does_not_replace_a_pipe(self):
        os.mkfifo(self.folder / "a.h5")
        self.says("a.h5: is a pipe or a device, which the output would replace; name a file", "mesh",
                  "box.obj", "-o", "a.h5")


class Images(FileTest):
    LARGE = ("texture picture has {0} x {0} pixels, --max-image allows 100 million; make it smaller "
             "or allow more; the factor alone counts, material: paint")

    def put_image(self, image):
        document = input_files.triangle()
        data = input_files.with_image(document, input_files.triangle_data(), image)
        return self.put("a.glb", input_files.glb(document, data))

    def test_sizes_are_judged_before_pixels(self):
        for make, size in [(input_files.png, 60000), (input_files.bmp, 60000),
                           (input_files.gif, 60000), (input_files.psd, 60000),
                           (input_files.webp, 16000)]:
            with self.subTest(make=make.__name__):
                image = make(size, size, 0) if make is input_files.png else make(size, size)
                text = self.passes("info", self.put_image(image))
                self.assertIn(self.LARGE.format(size), text)

    def test_the_limit_is_an_option(self):
        name = self.put_image(input_files.png(40, 50))
        self.assertIn("1 texture read", self.passes("info", name))
        self.assertIn("has 40 x 50 pixels, --max-image allows 0.001 million",
                      self.passes("info", name, "--max-image", "0.001"))
        self.says("--max-image: 0 megapixels is out of range; above 0 and at most 2000", "info", name,
                  "--max-image", "0")

    def test_the_limit_holds_for_compared_pictures(self):
        self.put("p.png", input_files.png(60000, 60000, 0))
        self.says("p.png: has 60000 x 60000 pixels, --max-image allows 100 million; make it smaller or "
                  "allow more; what can be compared: results (.h5), lit meshes (.glb, .gltf, .ply, "
                  ".obj), pictures", "compare", "p.png", "p.png")

    def test_unknown_and_damaged_images_cannot_be_decoded(self):
        self.assertIn("texture picture cannot be decoded (of an unknown image format)",
                      self.passes("info", self.put_image(b"not an image")))
        self.assertIn("texture picture cannot be decoded",
                      self.passes("info", self.put_image(input_files.png(40, 40)[:60])))
        # libpng prints unless it is told not to: no line may be its own.
        image = bytearray(input_files.png(40, 40))
        image[29] ^= 1  # of the header's check sum
        run = self.run_limited("info", self.put_image(bytes(image)))
        for line in run.stderr.decode().splitlines():
            # The program's own lines, with progress on a slow machine.
            self.assertRegex(line, r"^(radiosity|reading): ")


class LargeFiles(FileTest):
    def test_a_polygon_of_many_corners_is_read(self):
        count = 20000
        corners = "".join(f"v {k} {k * k / count} 0\n" for k in range(count))
        self.put("a.obj", corners + "f " + " ".join(str(k + 1) for k in range(count)) + "\n")
        self.assertIn(f"triangles                        {count - 2:,}\n", self.passes("info", "a.obj"))

    def test_many_objects_groups_and_materials_are_read(self):
        for keyword in ["o", "g", "usemtl"]:
            parts = "".join(f"{keyword} part{k}\nv {k} 0 0\nv {k} 1 0\nv {k} 0 1\nf -3 -2 -1\n"
                            for k in range(40000))
            self.put("a.obj", parts)
            with self.subTest(keyword=keyword):
                self.passes("info", "a.obj")

    def test_many_closed_parts_are_read(self):
        box = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
        faces = "f -8 -5 -6 -7\nf -4 -3 -2 -1\nf -8 -7 -3 -4\nf -7 -6 -2 -3\nf -6 -5 -1 -2\nf -5 -8 -4 -1\n"
        text = "".join("".join(f"v {2 * (k % 150) + x} {2 * (k // 150) + y} {z}\n" for x, y, z in box)
                       + faces for k in range(22500))
        self.put("a.obj", text)
        self.assertRegex(self.passes("info", "a.obj"), r"watertight +yes")

    def test_many_faces_around_one_point_are_read(self):
        count = 30000
        ring = "".join(f"v {k / count} {1 - k / count} 0\n" for k in range(count + 1))
        fan = "".join(f"f 1 {k + 2} {k + 3}\n" for k in range(count))
        self.put("a.obj", "v 0 0 0\n" + ring + fan)
        self.passes("info", "a.obj")

    def test_a_word_of_megabytes_is_shortened_in_the_message(self):
        self.put("a.obj", "v 0 0 " + "x" * 5000000 + "\n")
        run = self.run_limited("info", "a.obj")
        self.assertEqual(run.returncode, 2)
        self.assertLess(len(run.stderr), 2200)
        self.assertIn(b"[4.8 MiB left out]", run.stderr)


class Ply(FileTest):
    def compare(self, text, line):
        self.put("a.ply", text)
        self.says(f"a.ply: {line}", "compare", "a.ply", "a.ply", "--a-is", "srgb8", "--b-is", "srgb8")

    def test_impossible_element_counts_are_refused(self):
        self.compare("ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n",
                     "its `vertex` elements have no properties; export it again")
        self.compare("ply\nformat ascii 1.0\nelement other 4000000000\nend_header\n",
                     "its `other` elements have no properties; export it again")
        self.compare(input_files.PLY.replace("vertex 3", "vertex 4000000000"),
                     "claims 4000000000 `vertex` elements and ends before; export it again")
        self.compare(input_files.PLY.replace("vertex 3", "vertex 3000000000000000000000"),
                     "'element vertex 3000000000000000000000' in its header is not understood; export "
                     "it again")


class ControlCharacters(FileTest):
    def test_control_characters_of_scenes_are_quoted(self):
        """Text of a file reaches the terminal quoted: no byte of it is a command."""
        escape = "\x1b]0;title\x07\x1b[31m\x9b1m"
        self.put("a.obj", f"v 0 0 0\nv 1 0 0\nv 0 1 0\no {escape}\nf 1 2 3\n")
        self.assertIn(r"\x1b]0;title\x07\x1b[31m\xc2\x9b1m", self.quoted("info", "a.obj"))
        self.put("a.obj", f"v 0 0 {escape}\n")
        self.assertIn(r"`\x1b]0;title", self.quoted("info", "a.obj"))

        def rename(document):
            document["nodes"][0]["name"] = escape + "\n\r\t"
            document["materials"][0]["name"] = escape
        self.assertIn(r"; \r\t/", self.quoted("info", self.put_triangle(rename)))

    def test_control_characters_of_a_results_file_are_quoted(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "s.h5")
        with h5py.File(self.folder / "s.h5", "a") as file:
            for name, place in [("version", "/"), ("key", "/mesh"), ("key", "/solution")]:
                file[place].attrs.create(name, numpy.bytes_(b"\x1b[2Jx"))
            file["scene"].attrs.create("unit", numpy.bytes_(b"\x1b[3J"))
        self.assertIn(r"\x1b[2Jx", self.quoted("info", "s.h5"))

    def quoted(self, *arguments):
        run = self.run_limited(*arguments)
        text = (run.stdout + run.stderr).decode()
        for character in text.replace("\n", ""):
            self.assertFalse(ord(character) < 0x20 or 0x7f <= ord(character) < 0xa0, repr(text))
        return text


class FirstImpressions(FileTest):
    def test_the_first_commands_of_the_readme_warn_of_nothing(self):
        for command in [["info"], ["render", "-o", "p.png", "-o", "p.h5", *SMALL]]:
            run = self.run_program(command[0], DATA / "cornell-box.obj", *command[1:])
            self.assertNotIn("warning", run.err.lower())

    def test_a_name_shared_by_object_and_material_is_listed_once(self):
        self.put("a.obj", "mtllib box.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no lamp\nusemtl lamp\nf 1 2 3\n"
                          "o shade\nusemtl lamp\nf 1 2 3\n")
        report = self.report("info", "a.obj", "--set", "lamp.reflectance=0.25")
        self.assertEqual([s["name"] for s in report["scene"]["surfaces"]], ["lamp", "shade/lamp"])
        # The name means the material, also on the other object.
        self.assertIn(["lamp", "0.25, 0.25, 0.25"],
                      [[m["name"], m["reflectance"]] for m in report["scene"]["materials"]])
        self.assertEqual(len([m for m in report["scene"]["materials"] if m["name"] == "lamp"]), 1)


class TwoRunsAtOnce(FileTest):
    def test_concurrent_updates_leave_the_results_of_one_run(self):
        """Runs that update one file in different ways: each succeeds or reports that another was
        quicker, and the file is whole."""
        self.run_program("solve", "box.obj", *SMALL, "-o", "s.h5")
        runs = [subprocess.Popen([PROGRAM, "solve", "s.h5", "--patches", str(40 + 20 * (k % 4)),
                                  "--set", f"wall.reflectance=0.{k + 1}"],
                                 cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 text=True) for k in range(8)]
        for run in runs:
            _, err = run.communicate(timeout=300)
            if run.returncode != 0:
                # Warnings and progress may stand before it.
                self.assertEqual(err.splitlines()[-1],
                                 "radiosity: s.h5: was replaced by another run meanwhile; run "
                                 "this one again")
                self.assertEqual(run.returncode, 1)
        self.run_program("info", "s.h5")
        self.assertRegex(self.run_program("solve", "s.h5").out, r"(?s)form factors +reused.*solution +reused")
        self.assertEqual(self.files(), ["box.mtl", "box.obj", "s.h5"])


if __name__ == "__main__":
    sys.exit(unittest.main())
