"""The program: `smachac`, and `python -m smachac`."""

import sys


def program() -> int:
    """Run the command in sys.argv; the exit code. Ctrl-C is handled before the command line is
    imported."""
    try:
        from smachac.commands.interrupts import end_at_interrupts

        end_at_interrupts()
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr, flush=True)
        return 130
    from smachac.commands.cli import main

    return main()


if __name__ == "__main__":
    sys.exit(program())
