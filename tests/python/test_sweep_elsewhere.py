"""The same sweep through a real Slurm with two workers, and under GNU parallel: the local table, bit for bit."""
import contextlib
import os
import shutil
import socket
import subprocess
import time

import pytest
from sweep_stand_in import fill, run, runs

TABLES = ("results.json", "results.csv")

CONFIGURATION = """\
ClusterName=mesograin
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmctldPort={controller_port}
SlurmdPort={worker_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=1,batch_sched_delay=0
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
MailProg=/bin/true
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES State=UP
"""


@pytest.fixture
def sweep(tmp_path):
    fill(tmp_path)
    assert run(tmp_path, out="local").returncode == 0
    (tmp_path / "runs").unlink()
    return tmp_path


def merged_like_local(sweep):
    assert run(sweep, "--merge").returncode == 0
    for name in TABLES:
        assert (sweep / "out" / name).read_bytes() == (sweep / "local" / name).read_bytes()


@pytest.fixture
def slurm(tmp_path):
    """The environment in which sbatch finds a cluster of its own: one node, two processors."""
    missing = [name for name in ("munged", "slurmctld", "slurmd", "sbatch") if not which(name)]
    if missing:
        pytest.skip(f"{missing[0]} is not installed; Debian's packages: munge slurmctld slurmd slurm-client")
    if os.geteuid() != 0:
        pytest.skip("Slurm's daemons need root")
    folder = tmp_path / "slurm"
    folder.mkdir(mode=0o755)
    for name in ("state", "spool"):
        (folder / name).mkdir()
    key = folder / "munge.key"
    key.write_bytes(os.urandom(128))
    key.chmod(0o400)
    names = {"host": socket.gethostname().split(".")[0], "folder": folder}
    (folder / "slurm.conf").write_text(
        CONFIGURATION.format(**names, controller_port=free_port(), worker_port=free_port())
    )
    environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"), "PATH": f"{os.environ['PATH']}:/usr/sbin"}
    munge = [which("munged"), "--foreground", "--force"]
    munge += [f"--{name}={folder / 'munge'}.{name.removesuffix('-file')}"
              for name in ("socket", "key-file", "pid-file", "log-file", "seed-file")]
    with contextlib.ExitStack() as stack:
        for words in (munge, [which("slurmctld"), "-D"], [which("slurmd"), "-D"]):
            stack.enter_context(daemon(words, environment, folder))
        deadline = time.monotonic() + 60.0
        while "idle" not in asked(["sinfo", "--noheader", "--format=%T"], environment):
            assert time.monotonic() < deadline, log_of(folder)
            time.sleep(0.2)
        yield environment
        asked(["scancel", "--signal=KILL", "--full", "--user", "root"], environment)


def which(name):
    return shutil.which(name) or shutil.which(name, path="/usr/sbin")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@contextlib.contextmanager
def daemon(words, environment, folder):
    with open(folder / "daemons.log", "ab") as log:
        process = subprocess.Popen(words, env=environment, stdout=log, stderr=log, stdin=subprocess.DEVNULL)
    try:
        yield
    finally:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def asked(words, environment):
    return subprocess.run(words, env=environment, capture_output=True, text=True, timeout=60).stdout


def log_of(folder):
    return "".join(path.read_text(errors="replace") for path in sorted(folder.glob("*.log")))


def test_a_slurm_array_gives_the_local_table(sweep, slurm):
    script = run(sweep, "--emit", "slurm", "--jobs", "2").stdout.strip()
    # The stand-ins wait for one another: with one worker they would never end.
    environment = {**slurm, "STAND_IN_TOGETHER": "2"}
    done = subprocess.run(["sbatch", "--wait", script], env=environment, capture_output=True, text=True, timeout=120)
    logs = "".join(path.read_text() for path in (sweep / "out").glob("slurm-*.log"))
    assert done.returncode == 0, done.stderr + logs + log_of(sweep / "slurm")
    assert len(list((sweep / "out").glob("slurm-*.log"))) == 3, "a task for each group of cases that share a reference"
    assert runs(sweep) == 6
    merged_like_local(sweep)


def test_a_failed_task_is_seen_and_its_sweep_goes_on(sweep, slurm):
    script = run(sweep, "--emit", "slurm", "--jobs", "2").stdout.strip()
    done = subprocess.run(["sbatch", "--wait", script], env={**slurm, "STAND_IN_FAILS": "2.0"}, timeout=120)
    assert done.returncode == 1
    assert "2 of 6 cases have no result yet" in run(sweep, "--merge").stdout
    assert subprocess.run(["sbatch", "--wait", script], env=slurm, timeout=120).returncode == 0
    assert runs(sweep) == 8, "only the two that failed run again"
    merged_like_local(sweep)


def test_gnu_parallel_gives_the_local_table(sweep):
    if not shutil.which("parallel") or "GNU" not in asked(["parallel", "--version"], os.environ):
        pytest.skip("GNU parallel is not installed; the Debian package is parallel")
    script = run(sweep, "--emit", "parallel", "--jobs", "2").stdout.strip()
    environment = {**os.environ, "STAND_IN_TOGETHER": "2"}
    done = subprocess.run([script], env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    merged_like_local(sweep)
