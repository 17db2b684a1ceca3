#!/usr/bin/env python3
"""Checks that every module includes only what tools/layers.txt allows.

usage: check_layers.py [--root DIR]

Prints one line per violation, `bezel/numeric/eft.cpp:3: numeric may not include bernstein`, and exits 1;
exits 0 and prints nothing when all is well, 2 when layers.txt itself is wrong.
"""

import argparse
import posixpath
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')
SUFFIXES = {".hpp", ".cpp", ".h", ".inc"}


class LayersError(Exception):
    """layers.txt is wrong."""


def read_layers(path):
    """Allowed modules per module; None stands for all of them."""
    allowed = {}
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        line = line.split("#", 1)[0].strip()
        if not line:
            continue
        name, colon, rest = line.partition(":")
        name = name.strip()
        if not colon or not re.fullmatch(r"[a-z_]+", name):
            raise LayersError(f"{path.name}:{number}: found '{line}', expected 'module: modules it may include'")
        if name in allowed:
            raise LayersError(f"{path.name}:{number}: {name} is listed twice")
        names = rest.split()
        for other in names:
            if other != "*" and other not in allowed:
                raise LayersError(f"{path.name}:{number}: {name} names {other}, which no line above defines")
        if "*" in names and len(names) > 1:
            raise LayersError(f"{path.name}:{number}: '*' stands alone")
        allowed[name] = None if names == ["*"] else set(names)
    return allowed


def strip_comments(text):
    """Blanks out comments, keeping line numbers."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.S)


def included_module(folder, form, name, modules):
    """The module a file includes, or None. `folder` is the including file's, relative to the root."""
    if form == '"' and not name.startswith("bezel/"):
        name = posixpath.normpath(posixpath.join(folder, name))
    parts = name.split("/")
    if parts[0] == "bezel" and len(parts) > 2:
        return parts[1]
    return parts[0] if len(parts) > 1 and parts[0] in modules else None


def check(root):
    allowed = read_layers(root / "tools" / "layers.txt")
    programs = [name for name, names in allowed.items() if names is None]
    folders = [path for path in sorted((root / "bezel").iterdir()) if path.is_dir()]
    folders += [root / name for name in programs if (root / name).is_dir()]
    problems = []
    for folder in folders:
        module = folder.name
        if module not in allowed:
            problems.append(f"{folder.relative_to(root).as_posix()}: {module} is missing from tools/layers.txt")
            continue
        for path in sorted(folder.rglob("*")):
            if path.suffix not in SUFFIXES:
                continue
            where = path.relative_to(root).as_posix()
            text = strip_comments(path.read_text(encoding="utf-8"))
            for number, line in enumerate(text.splitlines(), 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                other = included_module(posixpath.dirname(where), *match.groups(), programs)
                if other is None or other == module:
                    continue
                if other not in allowed:
                    problems.append(f"{where}:{number}: {other} is not a module of tools/layers.txt")
                elif allowed[module] is not None and other not in allowed[module]:
                    problems.append(f"{where}:{number}: {module} may not include {other}")
    return problems


def main():
    parser = argparse.ArgumentParser(description="checks the module layers")
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parent.parent)
    root = parser.parse_args().root
    try:
        problems = check(root)
    except (LayersError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
