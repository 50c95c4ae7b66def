"""A process that has Snakemake loaded and runs it in forks of itself: loading takes longer than planning.

Reads one JSON object a line (folder, arguments), answers each with one (returncode, said).
"""

import json
import os
import subprocess
import sys
import tempfile
from collections import namedtuple

Done = namedtuple("Done", "returncode said")


class Planner:
    """The caller's side; to be used as a context."""

    def __enter__(self):
        pipe = subprocess.PIPE
        self.process = subprocess.Popen([sys.executable, __file__], stdin=pipe, stdout=pipe, text=True)
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.wait()

    def __call__(self, folder, *arguments):
        """Exit code and output of `snakemake` with these arguments in a folder, with the source there."""
        self.process.stdin.write(json.dumps([str(folder), arguments]) + "\n")
        self.process.stdin.flush()
        return Done(*json.loads(self.process.stdout.readline()))


def _attempt(folder, arguments):
    """Snakemake in a fork; all that it and its jobs print goes into a file."""
    with tempfile.TemporaryFile() as said:
        child = os.fork()
        if not child:
            with open(os.devnull) as nothing:
                os.dup2(nothing.fileno(), 0)
            for stream in (1, 2):
                os.dup2(said.fileno(), stream)
            _snakemake(folder, arguments)
        _, status = os.waitpid(child, 0)
        said.seek(0)
        return os.waitstatus_to_exitcode(status), said.read().decode()


def _snakemake(folder, arguments):
    """Ends the process."""
    import snakemake.cli

    os.chdir(folder)
    source = os.path.join(folder, "src")
    if os.path.isdir(source):
        sys.path.insert(0, source)
        os.environ["PYTHONPATH"] = source
    snakemake.cli.main(["--cores", "2", *arguments])
    sys.exit("snakemake came back")


if __name__ == "__main__":
    # What a start of Snakemake spends its time on; nothing of this project, whose copies differ.
    import grimp  # noqa: F401
    import msgspec  # noqa: F401
    import pandas  # noqa: F401
    import snakemake.cli
    import yaml  # noqa: F401

    snakemake.cli.get_argument_parser()
    for line in sys.stdin:
        print(json.dumps(_attempt(*json.loads(line))), flush=True)
