#!/usr/bin/env python3
"""Checks that the code blocks of the documentation are true.

usage: tools/check_docs.py [--build DIR] [PAGE...]   (default pages: README.md, CONTRIBUTING.md, docs/**/*.md)

A fenced block is checked by the words after its fence:

  ```cpp examples/NAME.cpp   equals that file, or a run of its lines
  ```cpp                     with a main(): compiles and runs against the build; without: not checked
  ```sh                      runs in bash, all blocks of a page in one temporary folder with the repository's data/ in
                             it and the build's `bezel` and examples on the PATH; must exit with 0
  ```sh fails CODE           the same, must exit with CODE
  ```text output             equals what the block before it printed on the standard output
  ```LANGUAGE skip REASON    not checked, for the reason given

Without --build only the comparisons with files are made. Prints each failure as page:line: message; exit code 1 if any.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIBRARIES = ["-lfmt", "-ltbb", "-lhwy", "-lpugixml", "-lz", "-lpng"]
LIMIT = 300  # seconds for one block


def blocks(text):
    """Yields (line of the fence, info words, body)."""
    fence = None
    for number, line in enumerate(text.splitlines(keepends=True), 1):
        if fence is None:
            match = re.match(r"^(```+)\s*(.*?)\s*$", line)
            if match:
                fence, start, words, body = match.group(1), number, match.group(2).split(), []
        elif line.rstrip() == fence:
            yield start, words, "".join(body)
            fence = None
        else:
            body.append(line)
    if fence is not None:
        yield start, ["unclosed"], ""


def run(command, folder, path):
    environment = dict(os.environ, PATH=os.pathsep.join(path + [os.environ["PATH"]]))
    return subprocess.run(command, cwd=folder, env=environment, text=True, timeout=LIMIT, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def last_line(text):
    lines = text.strip().splitlines()
    return lines[-1] if lines else "nothing on the standard error"


class Page:
    def __init__(self, path, build, scratch):
        self.path, self.build, self.failures, self.checked = path, build, [], 0
        self.folder = pathlib.Path(scratch)
        if build:
            shutil.copytree(ROOT / "data", self.folder / "data")
        self.printed = None

    def fail(self, line, message):
        name = self.path.relative_to(ROOT) if self.path.is_relative_to(ROOT) else self.path
        self.failures.append(f"{name}:{line}: {message}")

    def check(self):
        for line, words, body in blocks(self.path.read_text(encoding="utf-8")):
            if words[:1] == ["unclosed"]:
                self.fail(line, "the fence is never closed")
            elif "skip" in words[1:2]:
                if len(words) < 3:
                    self.fail(line, "a skipped block must give its reason")
            elif words[:2] == ["text", "output"]:
                if self.build:
                    self.output(line, body)
            elif words[:1] == ["sh"]:
                if self.build:
                    self.shell(line, words, body)
            elif words[:1] == ["cpp"] and len(words) == 2:
                self.file(line, words[1], body)
            elif words == ["cpp"] and re.search(r"\bmain\(", body) and self.build:
                self.program(line, body)

    def file(self, line, name, body):
        self.checked += 1
        source = ROOT / name
        if not source.is_file():
            self.fail(line, f"{name} does not exist")
        elif ("\n" + body) not in "\n" + source.read_text(encoding="utf-8"):
            self.fail(line, f"the block differs from {name}")

    def shell(self, line, words, body):
        self.checked += 1
        expected = int(words[2]) if words[1:2] == ["fails"] and len(words) > 2 else 0
        path = [str(self.build / "cli"), str(self.build / "examples")]
        try:
            result = run(["bash", "-euo", "pipefail", "-c", body], self.folder, path)
        except subprocess.TimeoutExpired:
            self.fail(line, f"the commands did not end within {LIMIT} s")
            return
        self.printed = result.stdout
        if result.returncode != expected:
            self.fail(line, f"the commands exit with {result.returncode}, expected {expected}: {last_line(result.stderr)}")

    def program(self, line, body):
        self.checked += 1
        source, program = self.folder / "block.cpp", self.folder / "block"
        source.write_text(body, encoding="utf-8")
        archives = sorted(str(a) for a in self.build.rglob("libbezel_*.a"))
        command = [os.environ.get("CXX", "g++"), "-std=c++20", "-ffp-contract=off", f"-I{ROOT}", str(source), "-o",
                   str(program), "-Wl,--start-group", *archives, "-Wl,--end-group", *LIBRARIES]
        compiled = run(command, self.folder, [])
        if compiled.returncode:
            first = next((t for t in compiled.stderr.splitlines() if "error" in t or "undefined" in t), "")
            self.fail(line, f"the program does not compile: {first or last_line(compiled.stderr)}")
            return
        result = run([str(program)], self.folder, [])
        self.printed = result.stdout
        if result.returncode:
            self.fail(line, f"the program exits with {result.returncode}: {last_line(result.stderr)}")

    def output(self, line, body):
        self.checked += 1
        if self.printed is None:
            self.fail(line, "no block before it printed anything")
        elif self.printed.strip() != body.strip():
            self.fail(line, f"the output differs, the block before it printed:\n{self.printed.rstrip()}")


def main():
    parser = argparse.ArgumentParser(description="Checks the code blocks of the documentation.")
    parser.add_argument("--build", type=pathlib.Path, help="build folder with the command line tool and the examples")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    arguments = parser.parse_args()
    build = arguments.build.resolve() if arguments.build else None
    if build and not (build / "CMakeCache.txt").is_file():
        parser.error(f"{arguments.build} is not a build folder")
    pages = [p.resolve() for p in arguments.pages] or [
        p for p in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))] if p.is_file()]
    failures, checked = [], 0
    for path in pages:
        with tempfile.TemporaryDirectory() as scratch:
            page = Page(path, build, scratch)
            page.check()
        failures += page.failures
        checked += page.checked
    for failure in failures:
        print(failure, file=sys.stderr)
    print(f"check_docs: {checked} blocks on {len(pages)} pages checked, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
