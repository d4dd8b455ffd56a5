"""Writes the scenes to a folder: python3 tests/everyday_scenes FOLDER [NAME ...] [--share S]

Full size without --share; --share 0.01 makes them of a hundredth of the faces."""

import argparse
from pathlib import Path

from generators import FULL_SIZE

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("name", nargs="*", help="of a generator; all without")
    parser.add_argument("--share", type=float, default=1.0, help="of the full number of faces")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    makers = {maker.__name__: maker for maker in FULL_SIZE}
    for name in arguments.name or makers:
        scene = makers[name](arguments.share * FULL_SIZE[makers[name]])
        path = scene.write(arguments.folder / name)
        print(f"{path}: {scene.face_count()} faces")
