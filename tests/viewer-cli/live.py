"""A server of glint live, as tests talk to it."""
import http.client
import json
import subprocess
import tempfile


class Refused(Exception):
    def __init__(self, status, answer):
        super().__init__(f"{status}: {answer}")
        self.status, self.code, self.message = status, answer.get("code"), answer.get("error", "")


class Live:
    def __init__(self, glint, *arguments, **more):
        self.said = tempfile.TemporaryFile("w+")  # a pipe that nobody reads would stop the server
        self.process = subprocess.Popen([glint, "live", *map(str, arguments)], stdout=subprocess.PIPE, stderr=self.said, text=True, **more)
        line = self.process.stdout.readline().strip()
        if "/#" not in line:
            raise RuntimeError(f"no address: {line} {self.read()}")
        self.address = line
        base, self.token = line.split("/#")
        self.host = base.removeprefix("http://")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def ask(self, method, path, body=None):
        """The JSON of an answer, or its bytes."""
        connection = http.client.HTTPConnection(self.host, timeout=300)
        headers = {"Authorization": f"Bearer {self.token}", "Content-Type": "application/json"}
        connection.request(method, f"/api/v1/{path}", None if body is None else json.dumps(body), headers)
        answer = connection.getresponse()
        data, kind = answer.read(), answer.getheader("Content-Type") or ""
        connection.close()
        if answer.status != 200:
            raise Refused(answer.status, json.loads(data))
        return json.loads(data) if kind.startswith("application/json") else data

    def get(self, path):
        return self.ask("GET", path)

    def post(self, path, **body):
        return self.ask("POST", path, body)

    def read(self):
        """What it has written to stderr."""
        self.process.wait(60)
        self.said.seek(0)
        return self.said.read()

    def end(self):
        """The exit status."""
        if self.process.poll() is None:
            self.process.terminate()
        status = self.process.wait(60)
        self.process.stdout.close()
        return status
