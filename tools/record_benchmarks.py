#!/usr/bin/env python3
"""Runs one benchmark program and records the result with what is needed to judge it.

usage: record_benchmarks.py BENCHMARK [--results DIR] [--repetitions N] [-- more arguments for the program]

Writes DIR/<name>-<date>.json (default benchmarks/results): Google Benchmark's results, and the processor, the compiler
and its flags, the commit, and the load average before and after. Refuses to overwrite a file of the same name.
"""

import argparse
import datetime
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout.strip()


def processor():
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown"


def cache_of(program):
    """The build tree's CMake cache, found above the program."""
    for folder in program.resolve().parents:
        cache = folder / "CMakeCache.txt"
        if cache.exists():
            entries = {}
            for line in cache.read_text(encoding="utf-8").splitlines():
                if ":" in line and "=" in line and not line.startswith(("#", "//")):
                    name, value = line.split("=", 1)
                    entries[name.split(":")[0]] = value
            return entries
    raise SystemExit(f"error: {program}: found no CMakeCache.txt above it, expected a program of a build tree")


def build_of(program):
    cache = cache_of(program)
    kind = cache.get("CMAKE_BUILD_TYPE", "")
    flags = " ".join(filter(None, [cache.get("CMAKE_CXX_FLAGS"), cache.get(f"CMAKE_CXX_FLAGS_{kind.upper()}"),
                                   "-std=c++20 -ffp-contract=off"]))
    compiler = output_of(cache["CMAKE_CXX_COMPILER"], "--version").splitlines()[0]
    return {"compiler": compiler, "flags": flags, "build_type": kind}


def commit():
    try:
        head = output_of("git", "rev-parse", "HEAD")
    except (OSError, subprocess.CalledProcessError):
        return "unknown"  # a source archive, or a machine without git
    # The results themselves do not make the tree differ from the commit that was measured.
    changed = output_of("git", "status", "--porcelain", "--untracked-files=no", "--", ":!benchmarks/results")
    return head + ("-modified" if changed else "")


def main():
    parser = argparse.ArgumentParser(description="records one benchmark program's results")
    parser.add_argument("benchmark", type=Path)
    parser.add_argument("--results", type=Path, default=ROOT / "benchmarks" / "results")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("rest", nargs="*", help="arguments for the program, after --")
    options = parser.parse_args()

    name = options.benchmark.name.removeprefix("bench_")
    target = options.results / f"{name}-{datetime.date.today().isoformat()}.json"
    if target.exists():
        raise SystemExit(f"error: {target} exists; remove it first to record again on the same day")
    record = {
        "benchmark": name,
        "processor": processor(),
        "cores": os.cpu_count(),
        **build_of(options.benchmark),
        "commit": commit(),
        "load_average_before": os.getloadavg(),
    }
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.json"
        subprocess.run(
            [options.benchmark.resolve(), f"--benchmark_out={out}", "--benchmark_out_format=json",
             f"--benchmark_repetitions={options.repetitions}", "--benchmark_enable_random_interleaving=true",
             *options.rest],
            check=True,
        )
        measured = json.loads(out.read_text(encoding="utf-8"))
    record["load_average_after"] = os.getloadavg()
    # Medians and spreads; the repetitions themselves are only bulk.
    record["results"] = [row for row in measured["benchmarks"] if row.get("run_type") == "aggregate"
                         or options.repetitions == 1]
    options.results.mkdir(parents=True, exist_ok=True)
    partial = target.with_suffix(".partial")
    partial.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    partial.replace(target)
    print(f"wrote {target}")


if __name__ == "__main__":
    sys.exit(main())
