"""`python -m smachac`: the command line."""

import sys

from smachac.commands.cli import main

if __name__ == "__main__":
    sys.exit(main())
