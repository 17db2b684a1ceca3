#!/usr/bin/env python3
"""Runs one end-to-end case of the command line tool.

usage: run_case.py BEZEL CASE.test

A case is a transcript. It runs in an empty folder that holds a copy of tests/cli/data as `data`.

    # a comment
    $ bezel info data/none.msh           a command (words as a shell splits them, no expansion)
    $full bezel info data/square.msh     the same with a standard output that is full
    2> error: data/none.msh: ...         a line of its standard error
    > ...                                a line of its standard output
    < data/in.json                       the file it reads as its standard input
    exit 3                               its exit code; 0 when not given
    files a.msh b.vtu                    the files the folder holds afterwards, besides data
    json .fields[0].min == -1            a value in the standard output read as one JSON object
    json .l2 < 1e-12                     also <=, >, >=, ~ (equal within 1e-12 relative)
    keys . a b c                         the keys of an object there, all of them, in any order
    json a.json .fields[0].min == -1     the same for a file (also `keys a.json ...`)
    contains > some words                instead of exact lines: standard output (or 2>) holds the words
    same a.msh b.msh                     two files hold the same bytes
    not-same a.msh b.msh
    write NAME SIZE FROM                 writes the first SIZE bytes of a file to another, before the next command
    mkdir NAME

Output that is neither stated nor asked about by json, keys or contains must be empty. After a command that fails the
folder must be exactly as before it: no file more, none changed. With exit code 1, which is an answer ("no"), `files`
may say otherwise.
"""

import json
import math
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile


class Failure(Exception):
    pass


def snapshot(folder):
    files = {}
    for root, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(root, name)
            with open(path, "rb") as f:
                files[os.path.relpath(path, folder)] = f.read()
    return files


def look_up(value, path):
    """.a[0].b in a JSON value; '.' is the value itself."""
    if path == ".":
        return value
    for key, index in re.findall(r"\.([A-Za-z_0-9]+)|\[(\d+)\]", path):
        value = value[key] if key else value[int(index)]
    return value


def compare(found, operator, expected):
    if operator == "==":
        return found == expected
    if operator == "~":
        return math.isclose(found, expected, rel_tol=1e-12)
    return {"<": found < expected, "<=": found <= expected, ">": found > expected, ">=": found >= expected}[operator]


class Command:
    """A command and what is said about it."""

    def __init__(self, line, number, full):
        self.line, self.number, self.full = line, number, full
        self.exit = 0
        self.out, self.err, self.checks = [], [], []
        self.loose_out = self.loose_err = False
        self.input = os.devnull


def parse(path):
    """A list of Command and of (kind, argument) preparations."""
    steps = []
    with open(path, encoding="utf-8") as f:
        for number, line in enumerate(f, 1):
            line = line.rstrip("\n")
            kind, _, rest = line.partition(" ")
            if not line.strip() or kind == "#":
                continue
            if kind in ("$", "$full"):
                steps.append(Command(rest, number, kind == "$full"))
                continue
            if kind in ("write", "mkdir"):
                steps.append((kind, rest))
                continue
            if not steps or not isinstance(steps[-1], Command):
                raise Failure(f"line {number}: '{kind}' before a command")
            command = steps[-1]
            if kind == ">":
                command.out.append(rest)
            elif kind == "2>":
                command.err.append(rest)
            elif kind == "<":
                command.input = rest
            elif kind == "exit":
                command.exit = int(rest)
            elif kind in ("json", "keys", "files", "same", "not-same", "contains"):
                if kind == "contains":
                    command.loose_err |= rest.startswith("2> ")
                    command.loose_out |= rest.startswith("> ")
                elif kind in ("json", "keys") and rest.startswith("."):
                    command.loose_out = True
                command.checks.append((kind, rest))
            else:
                raise Failure(f"line {number}: unknown directive '{kind}'")
    return steps


def check(kind, rest, out, err, folder):
    def from_file(name):
        with open(os.path.join(folder, name), "rb") as f:
            return f.read()

    if kind == "files":
        found = sorted(f for f in snapshot(folder) if not f.startswith("data" + os.sep))
        if found != sorted(rest.split()):
            raise Failure(f"files: found {found}, expected {sorted(rest.split())}")
    elif kind in ("same", "not-same"):
        a, b = rest.split()
        if (from_file(a) == from_file(b)) != (kind == "same"):
            raise Failure(f"{kind} {rest}: it is not so")
    elif kind == "contains":
        where, _, words = rest.partition(" ")
        if words not in (err if where == "2>" else out):
            raise Failure(f"contains {rest}: not found")
    else:
        name = "" if rest.startswith(".") else rest.split()[0]
        text = from_file(name).decode() if name else out
        path, _, said = rest[len(name) :].strip().partition(" ")
        value = look_up(json.loads(text), path)
        if kind == "keys":
            if sorted(value) != sorted(said.split()):
                raise Failure(f"keys {path}: found {list(value)}, expected {said.split()}")
        else:
            operator, _, expected = said.partition(" ")
            if not compare(value, operator, json.loads(expected)):
                raise Failure(f"json {rest}: found {value!r}")


def run(command, bezel, folder):
    words = shlex.split(command.line)
    if words[0] != "bezel":
        raise Failure("commands start with 'bezel'")
    before = snapshot(folder)
    with open("/dev/full", "wb") as full, open(os.path.join(folder, command.input), "rb") as given:
        result = subprocess.run(
            [bezel] + words[1:],
            cwd=folder,
            stdin=given,
            stdout=full if command.full else subprocess.PIPE,
            stderr=subprocess.PIPE,
            timeout=300,
            check=False,
        )
    out, err = (result.stdout or b"").decode(), result.stderr.decode()
    shown = f"exit {result.returncode}\n--- stdout\n{out}--- stderr\n{err}---"
    try:
        if result.returncode != command.exit:
            raise Failure(f"exit code {result.returncode}, expected {command.exit}")
        for what, found, expected, loose in (
            ("stdout", out, command.out, command.loose_out),
            ("stderr", err, command.err, command.loose_err),
        ):
            if expected or not loose:
                wanted = "".join(line + "\n" for line in expected)
                if found != wanted:
                    raise Failure(f"{what}: expected\n{wanted}---")
        answered = result.returncode == 0 or (result.returncode == 1 and any(kind == "files" for kind, _ in command.checks))
        if not answered and snapshot(folder) != before:
            raise Failure("a failing command changed files")
        for kind, rest in command.checks:
            check(kind, rest, out, err, folder)
    except (Failure, KeyError, IndexError, TypeError, ValueError, OSError) as error:
        raise Failure(f"line {command.number}: $ {command.line}\n{type(error).__name__}: {error}\n{shown}") from error


def main():
    bezel, case = os.path.abspath(sys.argv[1]), sys.argv[2]
    steps = parse(case)
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(os.path.join(os.path.dirname(os.path.abspath(case)), "..", "data"), os.path.join(folder, "data"))
        for step in steps:
            if isinstance(step, Command):
                run(step, bezel, folder)
            elif step[0] == "mkdir":
                os.mkdir(os.path.join(folder, step[1]))
            else:
                name, size, source = step[1].split()
                with open(os.path.join(folder, source), "rb") as f, open(os.path.join(folder, name), "wb") as g:
                    g.write(f.read(int(size)))


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"{sys.argv[2]}: {failure}")
