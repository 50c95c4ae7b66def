"""A Slurm of one node on this machine, from Debian's packages slurm-wlm and munge: `with Slurm(folder): …`.

Everything lies in one folder; nothing of the system's own configuration is read or written. The daemons run
as the user who starts them.
"""

import os
import shutil
import socket
import subprocess
import time
from pathlib import Path

DAEMONS = ("munged", "slurmctld", "slurmd")
CURE = "apt-get install slurm-wlm munge"
PATIENCE_S = 60.0
CONF = """\
ClusterName=one
SlurmctldHost={host}
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MinJobAge=604800
SlurmdTimeout=20
ReturnToService=2
JobRequeue=1
MpiDefault=none
NodeName={host} CPUs={cpus} RealMemory={memory} State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


class Slurm:
    """Three daemons and their configuration; a context.

    Attributes:
        folder: where everything lies.
        environment: of commands that speak to this Slurm.
    """

    def __init__(self, folder: Path, cpus: int = 2):
        self.folder = folder
        self.cpus = cpus
        path = f"{folder / 'bin'}:{os.environ.get('PATH', '')}"
        self.environment = os.environ | {"SLURM_CONF": str(folder / "slurm.conf"), "PATH": path}
        self.running: dict[str, subprocess.Popen] = {}

    def __enter__(self) -> "Slurm":
        """
        Raises:
            SystemExit: where the packages are not installed, or the node does not come up.
        """
        missing = [name for name in DAEMONS if not which(name)]
        if missing:
            raise SystemExit(f"{', '.join(missing)}: not installed, so Slurm was not tried; {CURE}")
        for name in ("", "state", "spool", "bin"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        # munged wants folders that no other user can write; its socket's must be one that all can enter.
        self.folder.chmod(0o755)
        (self.folder / "munge.key").write_bytes(os.urandom(1024))
        (self.folder / "munge.key").chmod(0o600)
        host = socket.gethostname().partition(".")[0]
        content = CONF.format(
            host=host,
            folder=self.folder,
            user=_user(),
            cpus=self.cpus,
            memory=os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2**20 // 2,
            ports=(_port(), _port()),
        )
        (self.folder / "slurm.conf").write_text(content)
        # Snakemake's plugin takes SLURM_CONF away from what it starts inside a job.
        srun = self.folder / "bin/srun"
        srun.write_text(f'#!/bin/sh\nSLURM_CONF={self.folder}/slurm.conf exec {which("srun")} "$@"\n')
        srun.chmod(0o755)
        try:
            for name in DAEMONS:
                self.start(name)
            self._wait()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_) -> None:
        if "slurmctld" in self.running:
            self.call("scancel", "--user", _user())
        for name in reversed(DAEMONS):
            self.kill(name)

    def start(self, name: str) -> None:
        """Start one daemon, in the foreground of a process of its own."""
        place = self.folder
        words = {
            "munged": ["--foreground", "--force", f"--key-file={place}/munge.key"]
            + [
                f"--{kind}={place}/munge.{kind.split('-')[0]}" for kind in ("socket", "pid-file", "seed-file")
            ],
            "slurmctld": ["-D", "-c"],
            "slurmd": ["-D"],
        }[name]
        command = [which(name), *words]
        with open(self.folder / f"{name}.said", "a") as said:
            self.running[name] = subprocess.Popen(
                command, env=self.environment, stdout=said, stderr=said, start_new_session=True
            )
        if name == "munged":
            self._until(lambda: (place / "munge.socket").exists(), "munged has no socket")

    def kill(self, name: str) -> None:
        """Kill one daemon, as a failing node would."""
        process = self.running.pop(name, None)
        if process:
            process.kill()
            process.wait()

    def call(self, *words: str) -> str:
        """What a command of Slurm says."""
        done = subprocess.run(words, env=self.environment, capture_output=True, text=True, timeout=60)
        return done.stdout

    def _wait(self) -> None:
        self._until(lambda: "idle" in self.call("sinfo", "-h", "-o", "%T"), "the node does not come up")

    def _until(self, holds, told: str) -> None:
        until = time.monotonic() + PATIENCE_S
        while not holds():
            if time.monotonic() > until:
                logs = "".join(p.read_text()[-2000:] for p in sorted(self.folder.glob("*.said")))
                raise SystemExit(f"Slurm: {told}:\n{logs}")
            time.sleep(0.5)


def which(name: str) -> str | None:
    """Path of a daemon, which need not be on the user's path."""
    return shutil.which(name, path=f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin")


def _user() -> str:
    import pwd

    return pwd.getpwuid(os.getuid()).pw_name


def _port() -> int:
    """A port that is free now."""
    with socket.socket() as one:
        one.bind(("", 0))
        return one.getsockname()[1]
