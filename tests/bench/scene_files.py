"""The scene files that the program reads, by their names."""
SCENES = {".obj", ".gltf", ".glb", ".stl"}


def scene_files(paths):
    """All scene files among and under the paths, sorted."""
    found = {p for path in paths for p in (path.rglob("*") if path.is_dir() else [path])}
    return sorted(p for p in found if p.suffix.lower() in SCENES and p.is_file())
