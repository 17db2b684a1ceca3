"""Tests of tools/check_layers.py on made-up trees."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools" / "check_layers.py"
LAYERS = "base:\nnumeric: base\nbernstein: base numeric\ncli: *\n"


class CheckLayers(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)
        (self.root / "bezel").mkdir()
        self.write("tools/layers.txt", LAYERS)

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def run_tool(self):
        done = subprocess.run([sys.executable, TOOL, "--root", self.root], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout, done.stderr

    def test_allowed_includes_pass_silently(self):
        self.write("bezel/base/error.hpp", "#include <string>\n")
        self.write("bezel/bernstein/a.cpp", '#include "bezel/base/error.hpp"\n#include "bezel/numeric/eft.hpp"\n')
        self.write("bezel/numeric/eft.hpp", '#include "bezel/numeric/other.hpp"\n')
        self.write("cli/main.cpp", '#include "bezel/bernstein/a.hpp"\n')
        self.assertEqual(self.run_tool(), (0, "", ""))

    def test_violation_is_named_with_file_and_line(self):
        self.write("bezel/numeric/eft.cpp", '#include <cmath>\n\n#include "bezel/bernstein/index.hpp"\n')
        self.assertEqual(self.run_tool(), (1, "bezel/numeric/eft.cpp:3: numeric may not include bernstein\n", ""))

    def test_angle_brackets_spaces_and_relative_paths_do_not_hide_it(self):
        self.write("bezel/numeric/a.hpp", "#  include <bezel/bernstein/index.hpp>\n")
        self.write("bezel/numeric/b.hpp", '#include "../bernstein/index.hpp"\n')
        self.write("bezel/numeric/sub/c.hpp", '#include "../../bernstein/index.hpp"\n')
        code, out, _ = self.run_tool()
        self.assertEqual(code, 1)
        self.assertEqual(
            out.splitlines(),
            [
                "bezel/numeric/a.hpp:1: numeric may not include bernstein",
                "bezel/numeric/b.hpp:1: numeric may not include bernstein",
                "bezel/numeric/sub/c.hpp:1: numeric may not include bernstein",
            ],
        )

    def test_includes_in_comments_do_not_count(self):
        self.write("bezel/base/a.hpp", '// #include "bezel/numeric/a.hpp"\n/*\n#include "bezel/numeric/a.hpp"\n*/\n')
        self.assertEqual(self.run_tool(), (0, "", ""))

    def test_modules_may_not_include_programs(self):
        self.write("bezel/bernstein/a.cpp", '#include "../../cli/command.hpp"\n')
        self.write("cli/command.hpp", "\n")
        self.assertEqual(self.run_tool(), (1, "bezel/bernstein/a.cpp:1: bernstein may not include cli\n", ""))

    def test_unknown_modules_are_named(self):
        self.write("bezel/mystery/a.cpp", "\n")
        self.write("bezel/base/a.cpp", '#include "bezel/gone/a.hpp"\n')
        code, out, _ = self.run_tool()
        self.assertEqual(code, 1)
        self.assertEqual(
            out.splitlines(),
            [
                "bezel/base/a.cpp:1: gone is not a module of tools/layers.txt",
                "bezel/mystery: mystery is missing from tools/layers.txt",
            ],
        )

    def test_a_cycle_in_the_list_is_an_error(self):
        self.write("tools/layers.txt", "base: numeric\nnumeric: base\n")
        code, out, err = self.run_tool()
        self.assertEqual((code, out), (2, ""))
        self.assertEqual(err, "error: layers.txt:1: base names numeric, which no line above defines\n")

    def test_a_broken_line_is_an_error(self):
        self.write("tools/layers.txt", "base\n")
        code, _, err = self.run_tool()
        self.assertEqual(code, 2)
        self.assertEqual(err, "error: layers.txt:1: found 'base', expected 'module: modules it may include'\n")


if __name__ == "__main__":
    unittest.main()
