"""A Slurm of one node in a folder of its own: munged, slurmctld and slurmd without systemd, as root, with their own ports, sockets, key and configuration."""
import os
import secrets
import signal
import socket
import subprocess
import sys
import time

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
from tap import programs  # noqa: E402

CONFIGURATION = """\
ClusterName=glint
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CredType=cred/munge
SlurmctldPort={control_port}
SlurmdPort={node_port}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
MpiDefault=none
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MailProg=/bin/true
NodeName={host} NodeAddr=127.0.0.1 CPUs={tasks} CoresPerSocket={tasks} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(("127.0.0.1", 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


def until(what, holds, seconds=300):
    """Waits until holds() is true, and returns what it says."""
    end = time.monotonic() + seconds
    while not (found := holds()):
        assert time.monotonic() < end, f"{what}: not after {seconds} s"
        time.sleep(0.2)
    return found


class OneNode:
    """Started by `with`, and stopped however that ends."""

    def __init__(self, folder, tasks=2):
        self.folder, self.tasks, self.processes = os.path.abspath(folder), tasks, []
        self.host = socket.gethostname().split(".")[0]
        self.environment = {**os.environ, "SLURM_CONF": os.path.join(self.folder, "slurm.conf"), "MUNGE_SOCKET": os.path.join(self.folder, "munge/socket")}

    def __enter__(self):
        try:
            self.start()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_):
        self.stop()

    def write(self, name, text, mode=0o644):
        path = os.path.join(self.folder, name)
        with open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, mode), "wb") as file:
            file.write(text)
        return path

    def daemon(self, *words):
        log = self.write(os.path.basename(words[0]) + ".out", b"")
        with open(log, "ab") as out:
            self.processes.append(subprocess.Popen(words, env=self.environment, stdin=subprocess.DEVNULL, stdout=out, stderr=out, cwd=self.folder))

    def start(self):
        for name in ("munge", "state", "spool"):
            os.makedirs(os.path.join(self.folder, name), mode=0o755)
        control_port, node_port = free_ports(2)
        self.write("slurm.conf", CONFIGURATION.format(host=self.host, folder=self.folder, control_port=control_port, node_port=node_port,
                                                      tasks=self.tasks).encode())
        key = self.write("munge/key", secrets.token_bytes(128), 0o600)
        munge = os.path.join(self.folder, "munge")
        self.daemon(programs.find("munged"), "--foreground", "--force", f"--key-file={key}", f"--socket={munge}/socket", f"--pid-file={munge}/pid",
                    f"--log-file={munge}/log", f"--seed-file={munge}/seed")
        until("munged", lambda: os.path.exists(f"{munge}/socket"))
        self.daemon(programs.find("slurmctld"), "-D", "-c", "-f", self.environment["SLURM_CONF"])
        self.daemon(programs.find("slurmd"), "-D", "-N", self.host, "-f", self.environment["SLURM_CONF"])
        until("the node", lambda: self.says("sinfo", "-h", "-o", "%T").startswith("idle"))

    def stop(self):
        """Jobs first, which slurmd's end would leave behind."""
        if len(self.processes) > 1:
            self.says("scancel", "--user=root", "--signal=KILL")
            self.says("scancel", "--user=root")
            try:
                until("the queue's end", lambda: not self.says("squeue", "-h"), 30)
            except AssertionError:
                pass
        for process in reversed(self.processes):
            process.terminate()
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.wait()
        self.processes = []

    def says(self, *words):
        """What a client of it prints, "" if it fails."""
        run = subprocess.run(words, env=self.environment, capture_output=True, text=True)
        return run.stdout if run.returncode == 0 else ""
