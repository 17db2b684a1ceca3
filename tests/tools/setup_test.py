"""Tests of scripts/setup.sh with made-up dpkg-query, apt-get, id and sudo, so that nothing is installed."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "setup.sh"


class Setup(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.bin = Path(self.folder.name)
        self.log = self.bin / "log"
        self.stub("dpkg", "")
        self.stub("apt-get", f'echo "apt-get $*" >>{self.log}')
        self.stub("sudo", f'echo sudo >>{self.log}; exec "$@"')

    def stub(self, name, text):
        file = self.bin / name
        file.write_text(f"#!/bin/bash\n{text}\n", encoding="utf-8")
        file.chmod(0o755)

    def run_script(self, *arguments, missing=(), root=True):
        tests = " ".join(f'[ "$3" = {name} ] && exit 1;' for name in missing)
        self.stub("dpkg-query", f"{tests} printf installed")
        self.stub("id", f"echo {0 if root else 1000}")
        environment = {**os.environ, "PATH": f"{self.bin}:/usr/bin:/bin"}
        done = subprocess.run([SCRIPT, *arguments], capture_output=True, text=True, check=False, env=environment)
        calls = self.log.read_text(encoding="utf-8").splitlines() if self.log.exists() else []
        return done, calls

    def test_does_nothing_when_nothing_is_missing(self):
        for level in ("build", "test", "ci", "mpi"):
            done, calls = self.run_script(level)
            self.assertEqual((done.returncode, done.stdout, done.stderr, calls), (0, "", "", []))

    def test_installs_only_what_is_missing(self):
        done, calls = self.run_script("test", missing=["libhwy-dev", "libgtest-dev"])
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout, "Installing: libhwy-dev libgtest-dev\n")
        self.assertEqual(
            calls, ["apt-get update -qq", "apt-get install -y -qq --no-install-recommends libhwy-dev libgtest-dev"]
        )

    def test_a_level_leaves_out_what_only_the_next_needs(self):
        _, calls = self.run_script("build", missing=["libgtest-dev", "clang-14"])
        self.assertEqual(calls, [])
        _, calls = self.run_script("ci", missing=["libopenmpi-dev"])
        self.assertEqual(calls, [])

    def test_uses_sudo_when_not_root(self):
        done, calls = self.run_script("build", missing=["cmake"], root=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(calls[0], "sudo")
        self.assertIn("apt-get install -y -qq --no-install-recommends cmake", calls)

    def test_unknown_level(self):
        done, calls = self.run_script("everything")
        self.assertEqual((done.returncode, calls), (2, []))
        self.assertEqual(done.stderr, "error: found 'everything', expected build, test, ci or mpi\n")


if __name__ == "__main__":
    unittest.main()
