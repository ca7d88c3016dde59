#!/usr/bin/python3
"""Captures consecutive frames of a program with RenderDoc, without a window manager and without a key press.

  capture.py -o DIR [options] -- PROGRAM ARGUMENTS

Starts PROGRAM with RenderDoc injected, waits until it is where the frame is wanted, takes the frames, copies them to DIR as
NAME_0.rdc, NAME_1.rdc, … in the order in which they were drawn, and ends the program. A DISPLAY must be set; Xvfb's is enough.

Moments are numbers of frames: --at 150,200 takes the 150th frame that the program shows and those after it, then the 200th; 0 is
as soon as possible. A number that the program has passed before RenderDoc is connected, a fraction of a second, is never reached.
"""
import argparse
import os
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
    parser.add_argument("--frames", type=int, default=2, help="consecutive frames of each moment (default 2: a frame and its previous one)")
    parser.add_argument("--at", default="100", help="numbers of frames, with commas: the first of each moment (default 100)")
    parser.add_argument("--timeout", type=float, default=3600, help="seconds after which to give up (default 3600)")
    parser.add_argument("--module", default="", help="folder of renderdoc.so, where Python does not find it by itself")
    parser.add_argument("program", nargs="+", help="program and its arguments, after --")
    arguments = parser.parse_args()
    try:
        arguments.at = sorted(int(number) for number in arguments.at.split(","))
    except ValueError:
        parser.error(f"--at: expected numbers with commas between them, found {arguments.at}")
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

    def end(self):
        try:
            os.kill(self.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass  # it ended by itself
        self.control.Shutdown()


def main():
    arguments = read_arguments()
    if not os.environ.get("DISPLAY"):
        stop("DISPLAY is not set; start one with: Xvfb :77 -screen 0 640x360x24 &")
    if arguments.module:
        sys.path.insert(0, arguments.module)
    import renderdoc as rd
    os.makedirs(arguments.folder, exist_ok=True)
    start = time.monotonic()
    target = Target(rd, arguments, start + arguments.timeout)
    number = 0
    try:
        for first in arguments.at:
            if first:
                target.control.QueueCapture(first, arguments.frames)
            else:
                target.control.TriggerCapture(arguments.frames)
        while number < len(arguments.at) * arguments.frames:
            for capture in sorted(target.messages(1), key=lambda c: c.frameNumber):
                path = os.path.join(arguments.folder, f"{arguments.name}_{number}.rdc")
                os.replace(capture.path, path)
                number += 1
                print(f"{time.monotonic() - start:.0f} s: frame {capture.frameNumber}: {path}, {os.path.getsize(path) / 1e6:.0f} MB", flush=True)
    finally:
        target.end()


if __name__ == "__main__":
    main()
