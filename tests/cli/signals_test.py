#!/usr/bin/env python3
"""A transfer that is stopped leaves nothing behind; its progress bar appears on a terminal only, after a second.

usage: signals_test.py BEZEL
"""

import os
import pty
import signal
import subprocess
import sys
import tempfile
import time

bezel = sys.argv[1]


def expect(right, what):
    if not right:
        sys.exit(f"failed: {what}")


def run(*words):
    subprocess.run([bezel, *words], check=True, stdout=subprocess.DEVNULL)


def files():
    return sorted(os.listdir("."))


def catches(process, number):
    """Whether the process has a handler for the signal, by what the system says of it."""
    with open(f"/proc/{process.pid}/status") as status:
        for line in status:
            if line.startswith("SigCgt:"):
                return int(line.split()[1], 16) >> (number - 1) & 1 == 1
    return False


def stopped_with(number, extra=()):
    before = files()
    with open("out.msh", "w") as old:
        old.write("old")
    process = subprocess.Popen([bezel, "transfer", "donor.vtu", "target.msh", "-o", "out.msh", *extra],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while process.poll() is None and not catches(process, number):
        time.sleep(0.002)
    process.send_signal(number)
    _, err = process.communicate(timeout=60)
    expect(process.returncode == 128 + number, f"exit code {process.returncode} after signal {number}")
    expect(err == "error: interrupted\n", f"standard error {err!r}")
    with open("out.msh") as old:
        expect(old.read() == "old", "the older file is as it was")
    os.remove("out.msh")
    expect(files() == before, f"files left: {files()}")


def seen_on_terminal(*words):
    """What the command writes to a terminal as its standard error, and how long it ran."""
    ours, its = pty.openpty()
    start = time.monotonic()
    process = subprocess.Popen([bezel, *words], stdout=subprocess.DEVNULL, stderr=its)
    os.close(its)
    seen = b""
    while True:
        try:
            some = os.read(ours, 4096)
        except OSError:  # the other end is closed
            break
        if not some:
            break
        seen += some
    os.close(ours)
    expect(process.wait() == 0, f"{words} failed: {seen!r}")
    return seen, time.monotonic() - start


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    run("mesh", "disc", "--size", "0.02", "--degree", "5", "-o", "target.msh")
    run("sample", "target.msh", "--field", "u = x*y", "--degree", "5", "-o", "donor.vtu")
    stopped_with(signal.SIGINT)
    stopped_with(signal.SIGTERM)
    stopped_with(signal.SIGINT, ["--report", "report.json"])

    words = ["transfer", "donor.vtu", "target.msh", "-o", "moved.vtu", "--threads", "1"]
    seen, seconds = seen_on_terminal(*words)
    expect(seconds > 1.0, f"the transfer took {seconds} s, too short to show a bar")
    expect(b"transfer [" in seen and b"%" in seen, f"no bar on a terminal: {seen!r}")
    expect(seen.endswith(b"\r\x1b[K"), f"the bar is not wiped: {seen!r}")
    plain = subprocess.run([bezel, *words], check=True, capture_output=True)
    expect(plain.stderr == b"", f"not a terminal: {plain.stderr!r}")

    run("mesh", "disc", "--size", "0.5", "-o", "small.msh")
    run("sample", "small.msh", "--field", "u = x", "-o", "small.vtu")
    short, _ = seen_on_terminal("transfer", "small.vtu", "small.msh", "-o", "moved.vtu")
    expect(short == b"", f"a short transfer shows {short!r}")
