"""A job is one call of tessera with its own output folder. Its done-file holds a key made from the command line, the
program and the jobs it needs, so that a second call reuses finished jobs and repeats changed ones.
"""
import dataclasses
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

from .sample import WHOLE

DONE = "done.json"
ENDED_LOST = 3  # tessera's exit code if fewer than half of the frames were tracked: a result, not an error


class JobFailed(Exception):
    """tessera failed; the text has its error line and the command."""


@dataclasses.dataclass(frozen=True)
class Job:
    """`name` is the folder below OUT/jobs; `arguments` follow the word tessera; `needs` are jobs that run first;
    `inputs` are files whose content is part of the key."""
    name: str
    arguments: tuple
    needs: tuple = ()
    inputs: tuple = ()


class Workbench:
    """Runs jobs of one tessera in one folder. Owner thread only. Several processes may share the folder if no two run
    the same job. Each job's key holds the program's sha256, so figures of two programs never meet in one table."""

    def __init__(self, tessera, out, tum=None, sample=WHOLE, log=sys.stderr):
        self.tessera = pathlib.Path(tessera).resolve()
        self.out = pathlib.Path(out).resolve()
        self.tum = pathlib.Path(tum).resolve() if tum else None
        self.sample = sample
        self.preset, self.only = None, ()   # options --preset and --only
        self.network = None                 # option --labels: path of a model
        self.parts, self.frames = (), None  # options --parts and --frames
        self.log = log
        self.digest = self._digest()
        self.version = self._version()

    def _digest(self):
        return hashlib.sha256(self.tessera.read_bytes()).hexdigest()

    def _version(self):
        """The program's version and the start of its sha256, so that a changed build counts as different."""
        text = subprocess.run([self.tessera, "--version"], capture_output=True, text=True, check=True).stdout.strip()
        return f"{text}, sha256 {self.digest[:12]}"

    def folder(self, name):
        return self.out / "jobs" / name

    def shown(self, job):
        """The command without paths of this machine: $OUT for --out, $TUM for --tum and the file name of --labels."""
        words = " ".join(["tessera", *job.arguments])
        if self.tum:
            words = words.replace(str(self.tum), "$TUM")
        if self.network:
            words = words.replace(self.network, pathlib.Path(self.network).name)
        return words.replace(str(self.out), "$OUT")

    def key(self, job):
        parts = [self.shown(job), self.version, *(self.key(need) for need in job.needs),
                 *(hashlib.sha256(pathlib.Path(file).read_bytes()).hexdigest() for file in job.inputs)]
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()

    def is_done(self, job):
        return self.record(job).get("key") == self.key(job)

    def record(self, job):
        """Content of the done-file: key, command, exit_code, seconds, busy_cores (used by others just before)."""
        try:
            return json.loads((self.folder(job.name) / DONE).read_text())
        except (OSError, ValueError):
            return {}

    def run(self, job):
        """Runs the needed jobs, then `job`, unless they are done. Returns its folder. Raises JobFailed."""
        for need in job.needs:
            self.run(need)
        folder = self.folder(job.name)
        if self.is_done(job):
            return folder
        if self._digest() != self.digest:
            raise JobFailed(f"{self.tessera}: built anew in the meantime, so the tables would mix two programs; run the "
                            "same command again")
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        busy, start = busy_cores() if self.sample == WHOLE else 0.0, time.monotonic()
        print(f"{job.name} ...", end="", flush=True, file=self.log)
        ended = subprocess.run([self.tessera, *job.arguments], capture_output=True, text=True, check=False)
        seconds = time.monotonic() - start
        (folder / "log.txt").write_text(ended.stdout + ended.stderr)
        print(f" {seconds:.0f} s", file=self.log)
        if ended.returncode not in (0, ENDED_LOST):
            last = (ended.stderr.strip().splitlines() or [f"ended with {ended.returncode}"])[-1]
            raise JobFailed(f"{last}\n  in: {self.shown(job)}")
        record = {"key": self.key(job), "command": self.shown(job), "exit_code": ended.returncode,
                  "seconds": round(seconds, 1), "busy_cores": round(busy, 2)}
        (folder / (DONE + ".part")).write_text(json.dumps(record, indent=1))
        os.replace(folder / (DONE + ".part"), folder / DONE)
        return folder

    def read(self, job, file):
        """Runs `job` and returns one of its JSON files."""
        return json.loads((self.run(job) / file).read_text())


def busy_cores(window_s=0.3):
    """How many cores other programs use now. None of our jobs runs meanwhile. 0 if the system does not report it."""
    def idle_and_all():
        ticks = [int(word) for word in pathlib.Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:9]]
        return ticks[3] + ticks[4], sum(ticks)
    try:
        idle, total = idle_and_all()
        time.sleep(window_s)
        idle_after, total_after = idle_and_all()
    except (OSError, ValueError, IndexError):
        return 0.0
    return (os.cpu_count() or 1) * (1 - (idle_after - idle) / max(1, total_after - total))


def with_needs(jobs):
    """`jobs` and all jobs they need, each once, needed ones first."""
    found = {}
    for job in jobs:
        for one in (*with_needs(job.needs), job):
            found.setdefault(one.name, one)
    return list(found.values())
