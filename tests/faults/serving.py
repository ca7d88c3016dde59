"""glint live with a fault: its requests are made twice, as the server goes on after a fault."""
import contextlib
import http.client
import json
import os
import re
import signal
import time

from process import Process, contents

LIMIT_S = 240


class Serving(Process):
    """A process that serves until it is interrupted. What it printed is replaced by its answers."""

    def run(self, *words, **more):
        self.rounds = []
        outcome = super().run(*words, **more)
        outcome.out, outcome.rounds = b"", self.rounds
        return outcome

    def talk(self, child):
        address = self.address(child)
        if address:
            base, token = address.split("/#")
            self.rounds = [self.ask_all(base.removeprefix("http://"), token, name) for name in ("x0", "x1")]
            with contextlib.suppress(ProcessLookupError):  # it has ended on its own
                os.kill(child, signal.SIGINT)

    def address(self, child):
        """The line that it prints, or None if it has ended."""
        until = time.monotonic() + LIMIT_S
        while time.monotonic() < until:
            printed = contents(self.report + ".out").decode() if os.path.exists(self.report + ".out") else ""
            if printed.count("\n") > 1:
                return printed.split("\n")[0]
            if not os.path.exists(f"/proc/{child}"):
                return None
            time.sleep(0.02)
        return None

    def ask_all(self, host, token, name):
        run = self.ask(host, token, "run", {"state": {}})
        made = json.loads(run[1]) if run[0] == 200 else {"run": 1, "picture": "composed"}
        return [self.ask(host, token, "registry"), run, self.ask(host, token, f"picture?run={made['run']}&image={made['picture']}"),
                self.ask(host, token, f"pixel?run={made['run']}&x=3&y=4"), self.ask(host, token, "write", {"state": {}, "name": name})]

    def ask(self, host, token, path, body=None):
        """The status and bytes of an answer; status 0: the connection ended without one."""
        connection = http.client.HTTPConnection(host, timeout=LIMIT_S)
        try:
            headers = {"Authorization": f"Bearer {token}", "Content-Type": "application/json"}
            connection.request("GET" if body is None else "POST", f"/api/v1/{path}", None if body is None else json.dumps(body), headers)
            answer = connection.getresponse()
            return answer.status, answer.read()
        except TimeoutError:
            return None, b""
        except (OSError, http.client.HTTPException):
            return 0, b""
        finally:
            connection.close()


def refusal(answer, words):
    """Whether a request was refused with a message that says why, or its connection ended."""
    status, data = answer
    return status == 0 or (status is not None and status >= 400 and re.search(words, data.decode(errors="replace")) is not None)


def judge(outcome, whole, words, same, once):
    """What is bad about the answers, or None. Answers of any round without a fault are right: the first run of a state is made, later it is there. One
    fault may have requests of one round refused, that in which it happens."""
    refused = set()
    for i, answers in enumerate(outcome.rounds):
        for k, answer in enumerate(answers):
            if answer[0] is None:
                return "hangs"
            if any(answer[0] == other[k][0] and same(answer[1], other[k][1]) for other in whole.rounds):
                continue
            refused.add(i)
            if not refusal(answer, words) or (once and len(refused) > 1):
                return f"request {k} of round {i + 1}: status {answer[0]}, {answer[1][:80]!r}"
    return None
