"""Where the command begins; an interruption while it is being loaded ends it as quietly as one later."""

import os


def main() -> None:
    """Load the command line and run it; see `sonicvacuum.cli.main` for how it ends."""
    try:
        from sonicvacuum.cli import main as run

        run()
    except KeyboardInterrupt:
        os._exit(130)
    except ImportError as error:
        # Some compiled libraries tell an interruption of their own loading as a failure to load.
        if isinstance(error.__cause__ or error.__context__, KeyboardInterrupt):
            os._exit(130)
        raise


if __name__ == "__main__":
    main()
