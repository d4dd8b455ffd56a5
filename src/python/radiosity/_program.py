"""Where the program of this package is."""

import sys
from pathlib import Path


def program() -> Path:
    """The program that was built or installed with this package."""
    here = Path(__file__).parent  # in a build folder, the folder of the link
    places = [
        here / "bin/radiosity",  # pip
        here.parents[3] / "bin/radiosity",  # cmake --install: PREFIX/lib/pythonX.Y/site-packages
        here.parents[1] / "radiosity",  # the build folder
    ]
    for place in places:
        if place.is_file():
            return place
    looked = ", ".join(str(place) for place in places)
    sys.exit(f"radiosity: the program is in none of {looked}; install the package again")
