"""glint live asked by many at once: live_stress.py GLINT SECONDS. Meant for builds with sanitizers, too: what they report fails it."""
import pathlib
import random
import sys
import tempfile
import threading
import time

import tap
from live import Live, Refused

GLINT, SECONDS = sys.argv[1], float(sys.argv[2])
CLIENTS = 12


class Client(threading.Thread):
    """Asks for anything, again and again. Refusals that say that a later request came first are right, all others are not."""

    def __init__(self, live, number, until):
        super().__init__(daemon=True)
        self.live, self.until, self.draw = live, until, random.Random(number)
        self.asked, self.given_up, self.failed = 0, 0, []
        self.run_answer = None

    def state(self):
        return {"preset": self.draw.choice(["mafia3", "kf2"]), "set": {"compose.intensity": self.draw.choice([1, 2, 3])} if self.draw.random() < 0.5 else {},
                "capture": self.draw.randrange(2)}

    def ask(self):
        draw, live = self.draw, self.live
        kind = draw.choice(["run", "urgent", "draft", "quick", "picture", "picture", "values", "difference", "figures", "probe", "answer", "preset", "pipeline", "report"])
        if kind in ("run", "urgent", "draft", "quick") or not self.run_answer:
            state = self.state()
            if state["preset"] == "kf2":
                state["set"] = {}
            self.run_answer = live.post("run", state=state, client="c", **{kind: True} if kind != "run" else {})
            return
        run, image = self.run_answer["run"], draw.choice(self.run_answer["images"])["name"]
        if kind == "picture":
            live.get(f"picture?run={run}&image={image}&format={draw.choice(['raw', 'png'])}&every={draw.choice([1, 2])}")
        elif kind == "values":
            live.post("values", x=3, y=4, size=[64, 36], of=[{"run": run, "image": image}])
        elif kind == "difference":
            live.get(f"difference?run={run}&other={run}&image={image}&format=raw")
        elif kind == "figures":
            live.post("figures", state=self.run_answer["state"], effect="reflection", against="truth", metrics=["rmse"], rounds=draw.randrange(2))
        elif kind == "probe":
            live.post("probe", state=self.run_answer["state"], x=draw.randrange(64), y=draw.randrange(36), reference=draw.random() < 0.5)
        elif kind == "answer":
            live.post("answer", state=self.run_answer["state"], effect="reflection", of="truth")
        elif kind == "preset":
            live.post("preset", state=self.run_answer["state"], name="mine")
        elif kind == "pipeline":
            live.post("pipeline", state=self.state())
        elif draw.random() < 0.2:
            live.post("report", a=self.run_answer["state"], b=self.run_answer["state"])

    def run(self):
        while time.monotonic() < self.until:
            try:
                self.asked += 1
                self.ask()
            except Refused as refusal:
                if refusal.code == "superseded":
                    self.given_up += 1
                elif "compose.intensity" not in refusal.message:
                    self.failed.append(str(refusal))
            except Exception as error:  # a test has to say what went wrong in a thread
                self.failed.append(repr(error))


class Tests:
    def __init__(self, folder):
        self.folder = folder

    def test_many_clients(self):
        for frames, name in ((2, "shot.exr"),):
            tap.glint("sample", "street", "--light=1", "-o", str(self.folder / name), "--frames", str(frames), "--size", "64x36", "--cube-size", "16", "--truth", "1")
        captures = sorted(p for p in self.folder.glob("*.exr") if "cubemaps" not in p.name)
        with Live(GLINT, *captures) as live:
            clients = [Client(live, number, time.monotonic() + SECONDS) for number in range(CLIENTS)]
            for client in clients:
                client.start()
            for client in clients:
                client.join(SECONDS + 300)
            failed = [f for client in clients for f in client.failed]
            asked, given_up = sum(c.asked for c in clients), sum(c.given_up for c in clients)
            said = live.end(), live.read()
        print(f"# {asked} requests of {CLIENTS} clients, {given_up} given up")
        assert not failed, failed[:5]
        assert asked > CLIENTS and given_up < asked, (asked, given_up)
        assert said == (0, ""), said


with tempfile.TemporaryDirectory() as work:
    sys.exit(tap.run(Tests(pathlib.Path(work))))
