"""Tests of tools/record_benchmarks.py with a made-up benchmark program."""

import datetime
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools" / "record_benchmarks.py"
PROGRAM = """#!/usr/bin/env python3
import json, sys
out = [a.split("=", 1)[1] for a in sys.argv if a.startswith("--benchmark_out=")][0]
rows = [{"name": "eft", "run_type": "iteration", "real_time": 2.0},
        {"name": "eft_median", "run_type": "aggregate", "real_time": 2.0}]
json.dump({"benchmarks": rows}, open(out, "w"))
"""


class RecordBenchmarks(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)
        self.program = self.root / "build" / "benchmarks" / "bench_eft"
        self.program.parent.mkdir(parents=True)
        self.program.write_text(PROGRAM, encoding="utf-8")
        self.program.chmod(0o755)
        self.cache = self.root / "build" / "CMakeCache.txt"
        self.cache.write_text(
            "CMAKE_BUILD_TYPE:STRING=Release\nCMAKE_CXX_FLAGS:STRING=-march=haswell\n"
            "CMAKE_CXX_FLAGS_RELEASE:STRING=-O3 -DNDEBUG\nCMAKE_CXX_COMPILER:FILEPATH=/usr/bin/c++\n",
            encoding="utf-8",
        )
        self.results = self.root / "results"
        self.target = self.results / f"eft-{datetime.date.today().isoformat()}.json"

    def run_tool(self):
        return subprocess.run([sys.executable, TOOL, self.program, "--results", self.results], capture_output=True,
                              text=True, check=False)

    def test_records_what_is_needed_to_judge_a_number(self):
        done = self.run_tool()
        self.assertEqual(done.returncode, 0, done.stderr)
        record = json.loads(self.target.read_text(encoding="utf-8"))
        self.assertEqual(record["benchmark"], "eft")
        self.assertEqual(record["flags"], "-march=haswell -O3 -DNDEBUG -std=c++20 -ffp-contract=off")
        self.assertRegex(record["commit"], "^([0-9a-f]{40}(-modified)?|unknown)$")
        self.assertEqual([row["name"] for row in record["results"]], ["eft_median"])
        for key in ("processor", "cores", "compiler", "load_average_before", "load_average_after"):
            self.assertTrue(record[key], key)

    def test_does_not_overwrite(self):
        self.results.mkdir()
        self.target.write_text("kept", encoding="utf-8")
        done = self.run_tool()
        self.assertEqual(done.returncode, 1)
        self.assertIn("exists; remove it first", done.stderr)
        self.assertEqual(self.target.read_text(encoding="utf-8"), "kept")

    def test_needs_a_build_tree_and_leaves_nothing_behind(self):
        self.cache.unlink()
        done = self.run_tool()
        self.assertEqual(done.returncode, 1)
        self.assertIn("found no CMakeCache.txt above it", done.stderr)
        self.assertFalse(self.target.exists())


if __name__ == "__main__":
    unittest.main()
