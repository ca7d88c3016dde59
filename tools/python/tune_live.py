"""Finds the fewest cells that screen rays may visit whose error is at most a hundredth above the best, through a running glint live: tune_live.py ADDRESS"""
import json
import sys
import urllib.request

base, token = sys.argv[1].split("/#")


def ask(path, **body):
    request = urllib.request.Request(f"{base}/api/v1/{path}", json.dumps(body).encode(), {"Authorization": f"Bearer {token}"})
    return json.load(urllib.request.urlopen(request))


errors = {}
for cells in (256, 128, 64, 32, 16, 8):
    state = {"preset": "mafia3", "set": {"screen_trace.cells": cells}}
    found = ask("figures", state=state, effect="reflection", against="truth", metrics=["symmetric"])
    errors[cells] = found["errors"][0]["value"]  # of all pixels
    print(f"{cells} cells: error {errors[cells]:.4f}, {found['fetches_px']:.2f} fetches a pixel")
print("enough:", min(cells for cells in errors if errors[cells] <= 1.01 * min(errors.values())))
