"""The server that http.py attacks, and a client that can send it anything."""
import json
import os
import select
import socket
import subprocess
import sys
import time

HOST = sys.argv[1]


class Answer:
    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    def json(self):
        return json.loads(self.body)

    def __repr__(self):
        return f"{self.status} {self.headers} {self.body[:300]}"


def read_answer(file, head=False):
    """The next answer, or None at the end of the connection."""
    line = file.readline()
    if not line:
        return None
    status, headers = int(line.split()[1]), {}
    while (line := file.readline().strip()):
        name, value = line.decode().split(":", 1)
        headers[name.lower()] = value.strip()
    if head:
        return Answer(status, headers, b"")
    if headers.get("transfer-encoding") == "chunked":
        body = b""
        while (size := int(file.readline(), 16)):
            body += file.read(size)
            file.readline()
        file.readline()
    else:
        body = file.read(int(headers["content-length"]))
    return Answer(status, headers, body)


class Server:
    def __init__(self, *arguments):
        environment = {**os.environ, "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":quarantine_size_mb=8"}
        self.process = subprocess.Popen([HOST, *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment)
        line = self.process.stdout.readline()
        if line:
            self.port, self.token = json.loads(line).values()
            self.name = f"127.0.0.1:{self.port}"

    def end(self):
        """Ends the server: seconds, status, and what it said."""
        start = time.monotonic()
        try:
            _, said = self.process.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
        return time.monotonic() - start, self.process.returncode, said.decode(errors="replace")

    def connect(self, timeout=10, address="127.0.0.1"):
        return socket.create_connection((address, self.port), timeout)

    def request(self, path, method="GET", token=True, body=b"", length=True, version="HTTP/1.1", **headers):
        """The bytes of a request. Headers are given by their names with _ for -; None leaves one out."""
        if isinstance(body, (dict, list)):
            body = json.dumps(body).encode()
        lines = {"Host": self.name, "Authorization": f"Bearer {self.token}" if token is True else token or None,
                 "Content-Length": str(len(body)) if body and length else None, **{k.replace("_", "-"): v for k, v in headers.items()}}
        text = f"{method} {path} {version}\r\n" + "".join(f"{k}: {v}\r\n" for k, v in lines.items() if v is not None) + "\r\n"
        return text.encode("latin-1") + body

    def send(self, data, head=False, **more):
        """Sends the bytes in a connection of its own; None: it was closed without an answer."""
        with self.connect(**more) as connection, connection.makefile("rb") as file:
            try:
                connection.sendall(data)
                return read_answer(file, head)
            except ConnectionError:
                return None

    def ask(self, path, method="GET", **more):
        return self.send(self.request(path, method, **more), head=method == "HEAD")

    def status(self, name):
        with open(f"/proc/{self.process.pid}/status", encoding="utf-8") as file:
            return next(int(line.split()[1]) for line in file if line.startswith(name + ":"))

    def state(self):
        """Files that are open, and threads."""
        return tuple(len(os.listdir(f"/proc/{self.process.pid}/{folder}")) for folder in ("fd", "task"))

    @staticmethod
    def answers_of(connections, seconds):
        """What each connection brings until it ends."""
        got, poll, of = [b""] * len(connections), select.poll(), {c.fileno(): i for i, c in enumerate(connections)}
        for connection in connections:
            poll.register(connection, select.POLLIN)
        end = time.monotonic() + seconds
        while of and time.monotonic() < end:
            for number, _ in poll.poll(100):
                try:
                    part = connections[of[number]].recv(65536)
                except ConnectionError:
                    part = b""
                got[of[number]] += part
                if not part:
                    poll.unregister(number)
                    del of[number]
        assert not of, f"{len(of)} of {len(connections)} connections without an end after {seconds} s"
        return got

    def at_once(self, count, data):
        connections = [self.connect() for _ in range(count)]
        try:
            for connection in connections:
                connection.sendall(data)
            return self.answers_of(connections, 15)
        finally:
            for connection in connections:
                connection.close()
