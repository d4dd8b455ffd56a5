"""`python -m radiosity` is the command line: the program itself takes over."""

import os
import sys

from ._program import program


def main() -> None:
    path = program()
    os.execv(path, [str(path), *sys.argv[1:]])


if __name__ == "__main__":
    main()
