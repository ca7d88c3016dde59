#!/usr/bin/python3
"""Captures consecutive frames of a program with RenderDoc, without a window manager and without a key press.

  capture.py -o DIR [options] -- PROGRAM ARGUMENTS

Starts PROGRAM with RenderDoc injected, waits until it is where the frame is wanted, takes the frames, copies them to DIR as
NAME_0.rdc, NAME_1.rdc, … in the order in which they were drawn, and ends the program. A DISPLAY must be set; Xvfb's is enough.

The moment is described by the program's own output: --output says where it goes (or where the program writes its log), --wait-for is a
regular expression that it must contain, and --delay counts seconds from there. --repeat takes several moments, --every seconds apart.
"""
import argparse
import os
import re
import shlex
import signal
import sys
import time


def stop(message):
    sys.exit("capture.py: " + message)


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", dest="folder", required=True, help="folder of the captures")
    parser.add_argument("--name", default="frame", help="start of the captures' names (default frame)")
    parser.add_argument("--frames", type=int, default=2, help="consecutive frames at each moment (default 2: a frame and its previous one)")
    parser.add_argument("--log", help="file to which the program writes its log; watched by --wait-for")
    parser.add_argument("--wait-for", help="regular expression that the log must contain first")
    parser.add_argument("--delay", type=float, default=0, help="seconds from there to the first capture")
    parser.add_argument("--repeat", type=int, default=1, help="number of moments")
    parser.add_argument("--every", type=float, default=60, help="seconds between moments (default 60)")
    parser.add_argument("--timeout", type=float, default=3600, help="seconds after which to give up (default 3600)")
    parser.add_argument("--module", default="", help="folder of renderdoc.so, where Python does not find it by itself")
    parser.add_argument("program", nargs="+", help="program and its arguments, after --")
    arguments = parser.parse_args()
    if arguments.wait_for and not arguments.log:
        parser.error("--wait-for needs --log")
    return arguments


class Target:
    """The running program, as RenderDoc sees it."""

    def __init__(self, rd, arguments, deadline):
        self.rd, self.deadline = rd, deadline
        options = rd.CaptureOptions()
        options.allowVSync = options.allowFullscreen = False
        options.refAllResources = False
        program, *rest = arguments.program
        result = rd.ExecuteAndInject(program, os.getcwd(), " ".join(shlex.quote(r) for r in rest), [],
                                     os.path.join(arguments.folder, ".taken"), options, False)
        if result.result != rd.ResultCode.Succeeded:
            stop(f"{program} could not be started: {result.result}")
        self.control = rd.CreateTargetControl("", result.ident, "glint", True)
        if self.control is None:
            stop(f"RenderDoc gives no connection to {program}: it ended at once, or another RenderDoc holds it")
        self.pid = self.control.GetPID()
        self.seen, self.reason = set(), "it has shown no frame through an API that RenderDoc knows"

    def messages(self, seconds):
        """New captures that the program reports within this time."""
        end = time.monotonic() + seconds
        found = []
        while time.monotonic() < end:
            message = self.control.ReceiveMessage(None)
            if message.type == self.rd.TargetControlMessageType.Disconnected:
                stop("the program ended before it was captured")
            if message.type == self.rd.TargetControlMessageType.RegisterAPI:
                use = message.apiUse
                self.reason = f"{use.name}: " + ("it shows no frames" if use.supported else use.supportMessage or "not supported by RenderDoc")
            if message.type == self.rd.TargetControlMessageType.NewCapture and message.newCapture.captureId not in self.seen:
                self.seen.add(message.newCapture.captureId)  # a connection repeats old captures
                found.append(message.newCapture)
            if message.type == self.rd.TargetControlMessageType.Noop:
                time.sleep(0.1)
            if time.monotonic() > self.deadline:
                stop(f"gave up after --timeout; {self.reason}")
        return found

    def take(self, frames):
        self.control.TriggerCapture(frames)
        taken = []
        while len(taken) < frames:
            taken += self.messages(1)
        return sorted(taken, key=lambda c: c.frameNumber)


def wait_for(target, arguments):
    if not arguments.wait_for:
        return
    pattern = re.compile(arguments.wait_for)
    while True:
        target.messages(2)
        try:
            with open(arguments.log, encoding="utf-8", errors="replace") as log:
                if pattern.search(log.read()):
                    return
        except FileNotFoundError:
            pass


def main():
    arguments = read_arguments()
    if not os.environ.get("DISPLAY"):
        stop("DISPLAY is not set; start one with: Xvfb :77 -screen 0 640x360x24 &")
    if arguments.module:
        sys.path.insert(0, arguments.module)
    import renderdoc as rd
    os.makedirs(arguments.folder, exist_ok=True)
    if arguments.log and os.path.exists(arguments.log):
        os.remove(arguments.log)  # what an earlier run said is no answer
    start = time.monotonic()
    target = Target(rd, arguments, start + arguments.timeout)
    number = 0
    try:
        wait_for(target, arguments)
        print(f"{time.monotonic() - start:.0f} s: the program is there", flush=True)
        target.messages(arguments.delay)
        for moment in range(arguments.repeat):
            if moment:
                target.messages(arguments.every)
            for capture in target.take(arguments.frames):
                path = os.path.join(arguments.folder, f"{arguments.name}_{number}.rdc")
                os.replace(capture.path, path)
                number += 1
                print(f"{time.monotonic() - start:.0f} s: frame {capture.frameNumber}: {path}, {os.path.getsize(path) / 1e6:.0f} MB", flush=True)
    finally:
        os.kill(target.pid, signal.SIGKILL)
        target.control.Shutdown()


if __name__ == "__main__":
    main()
