#!/usr/bin/env python3
"""Transfers by 1 to 4 processes beside the same transfer by one without MPI: all output files have the same bytes.

usage: run_mpi.py MPIEXEC NUMPROC_FLAG BEZEL NAME
"""

import json
import os
import subprocess
import sys
import tempfile

PROCESSES = (1, 2, 3, 4)

# name: commands that make donor.bzl and target.bzl, options of the transfer
CASES = {
    "straight": (["mesh square --width 2 --size 0.05 -o square.bzl",
                  "sample square.bzl -f u=sin(3*x)+y^2 -f flow=-y;x --degree 1 -o donor.bzl",
                  "mesh disc --radius 0.9 --size 0.04 --seed 2 -o target.bzl"], ""),
    "curved": (["mesh square --width 2 --size 0.1 --degree 3 -o square.bzl",
                "sample square.bzl -f u=sin(3*x)+y^2 -f flow=-y;x --degree 3 --basis physical -o donor.bzl",
                "mesh disc --radius 0.9 --size 0.06 --degree 2 --seed 2 -o target.bzl"],
               "--basis reference --degree 2"),
    "bounds": (["mesh square --width 2 --size 0.1 --degree 2 -o square.bzl",
                "sample square.bzl -f u=(x+abs(x))/(2*abs(x)) --degree 0 -o donor.bzl",
                "mesh disc --radius 0.9 --size 0.06 --degree 2 --seed 2 -o target.bzl"], "--degree 2 --bounds local"),
    "extend": (["mesh disc --radius 0.5 --size 0.05 --degree 2 -o disc.bzl",
                "sample disc.bzl -f u=exp(x)*y --degree 2 -o donor.bzl",
                "mesh square --width 2 --size 0.06 --seed 2 -o target.bzl"], "--uncovered extend --conserve total"),
    "continuous": (["mesh square --width 2 --size 0.1 --degree 2 -o square.bzl",
                    "sample square.bzl -f u=sin(3*x)+y^2 --degree 2 --continuity cg -o donor.bzl",
                    "mesh disc --radius 0.9 --size 0.06 --degree 2 --seed 2 -o target.bzl"], "--continuity cg"),
    "weight": (["mesh rectangle --width 2 --height 2 --center 1,0 --size 0.08 --degree 2 -o square.bzl",
                "sample square.bzl -f u=sin(3*x)+y^2 --degree 2 -o donor.bzl",
                "mesh disc --radius 0.9 --center 1,0 --size 0.06 --degree 2 --seed 2 -o target.bzl"], "--weight x"),
}

DONOR, TARGET = CASES["weight"][0][:1], CASES["weight"][0][2:]
CASES["density"] = (DONOR + ["sample square.bzl -f rho=2+y -f u=sin(3*x)+y^2 --degree 2 -o donor.bzl"] + TARGET,
                    "--density rho")


class Failure(Exception):
    pass


def expect(condition, what):
    if not condition:
        raise Failure(what)


class Folder:
    def __init__(self, path, mpiexec, flag, bezel):
        self.path, self.mpiexec, self.flag, self.bezel = path, mpiexec, flag, bezel

    def run(self, words, processes=None, environment=None):
        launcher = [] if processes is None else [self.mpiexec, self.flag, str(processes)]
        return subprocess.run(launcher + [self.bezel] + words.split(), cwd=self.path, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=250, env=environment)

    def must(self, words, processes=None):
        done = self.run(words, processes)
        expect(done.returncode == 0, f"'{words}' by {processes}: exit {done.returncode}: {done.stderr}")
        return done

    def bytes_of(self, name):
        with open(os.path.join(self.path, name), "rb") as f:
            return f.read()

    def json_of(self, name):
        return json.loads(self.bytes_of(name))


def without_times(report):
    return {k: v for k, v in report.items() if k not in ("seconds", "output", "processes")}


def compare(folder, commands, options):
    for command in commands:
        folder.must(command)
    folder.must(f"--threads 1 transfer donor.bzl target.bzl {options} -o one.bzl --report one.json")
    one = folder.json_of("one.json")
    for n in PROCESSES:
        folder.must(f"transfer donor.bzl target.bzl {options} -o many.bzl --report many.json", n)
        expect(folder.bytes_of("one.bzl") == folder.bytes_of("many.bzl"), f"{n} processes: other bytes")
        many = folder.json_of("many.json")
        expect(without_times(one) == without_times(many), f"{n} processes: another report")
        check_shares(many, n, many["pairs"])


def check_shares(report, n, pairs):
    if n == 1:
        expect("processes" not in report, "one process reports several")
        return
    shares = report["processes"]["shares"]
    expect(len(shares) == n and all(s["targets"] > 0 for s in shares), f"{n} processes: {shares}")
    expect(sum(s["pairs"] for s in shares) == pairs, f"{n} processes: pairs of shares")
    expect(report["processes"]["alone_cpu_seconds"] > 0, f"{n} processes: no time alone")
    expect(all(s["bytes_in"] > 0 and s["bytes_out"] > 0 for s in shares[1:]), f"{n} processes: no bytes")


def matrix(folder):
    """The operator's matrix, and fields moved by it, where meshes lie in each other in part, with bounds."""
    for command in ("mesh square --width 2 --size 0.1 --degree 2 -o square.bzl",
                    "sample square.bzl -f u=sin(3*x)+y^2 -f v=x --degree 2 -o donor.bzl",
                    "mesh disc --radius 1.1 --size 0.09 --degree 2 --seed 2 -o target.bzl"):
        folder.must(command)
    for options in ("--uncovered extend", "--uncovered zero --degree 1 --bounds -9,9"):
        words = f"transfer donor.bzl target.bzl {options} --report report.json -o"
        folder.must(f"--threads 1 {words} one.bzl --matrix one.mtx")
        for n in PROCESSES:
            folder.must(f"{words} many.bzl --matrix many.mtx", n)
            for kind in ("bzl", "mtx"):
                expect(folder.bytes_of(f"one.{kind}") == folder.bytes_of(f"many.{kind}"),
                       f"{options}, {n} processes: other bytes in .{kind}")
            report = folder.json_of("report.json")
            check_shares(report, n, report["pairs"])


def series(folder):
    """Steps on the same mesh, by an operator, and on another one, anew; with a weight all are moved anew."""
    for command in ("mesh rectangle --width 2 --height 2 --center 1,0 --size 0.1 --degree 2 -o square.bzl",
                    "mesh rectangle --width 2 --height 2 --center 1,0 --size 0.1 --degree 2 --seed 3 -o other.bzl",
                    "mesh disc --radius 0.9 --center 1,0 --size 0.07 --degree 2 --seed 2 -o target.bzl"):
        folder.must(command)
    for step, mesh in enumerate(("square", "square", "other")):
        folder.must(f"sample {mesh}.bzl -f u=sin(3*x)+y^2*{step} --degree 2 -o step{step}.bzl")
    with open(os.path.join(folder.path, "steps.pvd"), "w", encoding="ascii") as f:
        f.write('<VTKFile type="Collection" version="0.1"><Collection>\n')
        for step in range(3):
            f.write(f'<DataSet timestep="{step / 2}" file="step{step}.bzl"/>\n')
        f.write("</Collection></VTKFile>\n")
    os.mkdir(os.path.join(folder.path, "many"))  # the same names in both folders
    os.mkdir(os.path.join(folder.path, "one"))
    for options in ("--bounds local", "--weight x"):
        folder.must(f"--threads 1 transfer steps.pvd target.bzl {options} -o one/moved.pvd --report one.json")
        one = folder.json_of("one.json")
        for n in PROCESSES:
            folder.must(f"transfer steps.pvd target.bzl {options} -o many/moved.pvd --report many.json", n)
            for name in ["moved.pvd"] + [f"moved_{step:04}.vtu" for step in range(3)]:
                expect(folder.bytes_of(f"one/{name}") == folder.bytes_of(f"many/{name}"),
                       f"{options}, {n} processes: other bytes in {name}")
            many = folder.json_of("many.json")
            check_shares(many, n, sum(s["pairs"] for s in many["steps"][1 if "bounds" in options else 0:]))
            for report in (one, many):
                report["steps"] = [without_times(step) for step in report["steps"]]
            expect(without_times(one) == without_times(many), f"{options}, {n} processes: another report")


def largest_difference(folder, a, b):
    """Of the coefficients of two fields on one mesh, relative to the largest."""
    one, two = folder.bytes_of(a).decode().split(), folder.bytes_of(b).decode().split()
    start = one.index("coefficients") if "coefficients" in one else one.index("field")
    expect(one[:start] == two[:start] and len(one) == len(two), f"{a} and {b} lie on other meshes")
    number = lambda word: float.fromhex(word) if word.startswith(("0x", "-0x")) else 0.0
    values = [(number(v), number(w)) for v, w in zip(one[start:], two[start:])]
    largest = max(abs(v) for v, _ in values)
    expect(largest > 0.5, f"{a}: no coefficients")
    return max(abs(v - w) for v, w in values) / largest


def petsc(folder):
    """The mass system with its rows spread over the processes: to 1e-13 the field of one process."""
    for command in ("mesh rectangle --width 2 --height 2 --center 1,0 --size 0.1 --degree 2 -o square.bzl",
                    "sample square.bzl -f u=sin(3*x)+y^2 --degree 2 -o donor.bzl",
                    "mesh disc --radius 0.9 --center 1,0 --size 0.05 --degree 2 --seed 2 -o target.bzl"):
        folder.must(command)
    for options in ("", "--degree 3 --keep-boundary", "--weight x", "--bounds -9,9"):
        words = f"transfer donor.bzl target.bzl --continuity cg {options}"
        folder.must(f"{words} -o one.bzl")
        folder.must(f"{words} --mass-method petsc -o petsc.bzl")
        for n in PROCESSES:
            folder.must(f"{words} --mass-method petsc -o many.bzl --report many.json", n)
            for other in ("one.bzl", "petsc.bzl"):
                difference = largest_difference(folder, other, "many.bzl")
                expect(difference <= 1e-13, f"{options}, {n} processes: {difference} from {other}")
            if n == 1:
                expect(folder.bytes_of("petsc.bzl") == folder.bytes_of("many.bzl"), "one process: other bytes")
            report = folder.json_of("many.json")
            check_shares(report, n, report["pairs"])
            solve = report["fields"][0]["mass_solve"]
            expect(solve["method"] == "petsc" and solve["iterations"] > 0 and solve["relative_residual"] <= 1e-14,
                   f"{options}, {n} processes: {solve}")
    # What PETSc refuses, it refuses on all processes.
    before = sorted(os.listdir(folder.path))
    for wrong in ("-bezel_mass_pc_type none_such", "-bezel_mass_ksp_type none_such"):
        environment = dict(os.environ, PETSC_OPTIONS=wrong)
        words = "transfer donor.bzl target.bzl --continuity cg --mass-method petsc -o none.bzl"
        one = folder.run(words, environment=environment)
        many = folder.run(words, 3, environment)
        ours = [line for line in many.stderr.splitlines() if line.startswith("error: ")]
        expect(one.returncode == 4 and many.returncode == 4, f"{wrong}: exit {one.returncode}, {many.returncode}")
        expect(len(ours) == 1 and ours[0][:40] == one.stderr[:40], f"{wrong}: {many.stderr} instead of {one.stderr}")
        expect(sorted(os.listdir(folder.path)) == before, f"{wrong}: left files")
    many = folder.run(words, 3, dict(os.environ, PETSC_OPTIONS="-bezel_mass_pc_type icc"))  # for one process only
    expect(many.returncode == 4 and many.stderr.count("error: PETSc failed to solve") == 1, f"icc: {many.stderr}")


def tiny_last_triangle(path):
    """A quadratic mesh whose last triangle along the curve is too small for the numbers of its mass matrix."""
    n = 20
    nodes, triangles = [], []
    for j in range(2 * n + 1):
        for i in range(2 * n + 1):
            nodes.append((-3 + i / n, -3 + j / n))
    at = lambda i, j: j * (2 * n + 1) + i + 1
    for j in range(0, 2 * n, 2):
        for i in range(0, 2 * n, 2):
            triangles.append([at(i, j), at(i + 2, j), at(i, j + 2), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
            triangles.append([at(i + 2, j), at(i + 2, j + 2), at(i, j + 2), at(i + 2, j + 1), at(i + 1, j + 2),
                              at(i + 1, j + 1)])
    tiny = 1e-165
    first = len(nodes) + 1
    nodes += [(0, 0), (2 * tiny, 0), (0, 2 * tiny), (tiny, 0), (1.2 * tiny, 1.2 * tiny), (0, tiny)]
    triangles.append(list(range(first, first + 6)))
    with open(path, "w", encoding="ascii") as f:
        f.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(nodes)}\n")
        for k, (x, y) in enumerate(nodes):
            f.write(f"{k + 1} {x!r} {y!r} 0\n")
        f.write(f"$EndNodes\n$Elements\n{len(triangles)}\n")
        for k, t in enumerate(triangles):
            f.write(f"{k + 1} 9 2 1 1 {' '.join(map(str, t))}\n")
        f.write("$EndElements\n")


def errors(folder):
    """One message of ours, the exit code of a single process, and no file, whatever process met the error."""
    folder.must("mesh square --width 12 --size 1 --center 0.1,0.2 -o square.bzl")
    folder.must("sample square.bzl -f u=x --degree 1 -o donor.bzl")
    folder.must("mesh disc --radius 30 --size 5 -o large.bzl")
    tiny_last_triangle(os.path.join(folder.path, "tiny.msh"))
    before = sorted(os.listdir(folder.path))
    for words, code in (("transfer donor.bzl tiny.msh -o out.bzl", 4),
                        ("transfer donor.bzl large.bzl -o out.bzl", 3),
                        ("transfer donor.bzl none.bzl -o out.bzl", 3),
                        ("transfer donor.bzl large.bzl --degree 77 -o out.bzl", 2)):
        one = folder.run(words)
        expect(one.returncode == code, f"'{words}': exit {one.returncode}: {one.stderr}")
        for n in (2, 4):
            many = folder.run(words, n)
            ours = [line for line in many.stderr.splitlines() if line.startswith("error: ")]
            expect(ours == one.stderr.splitlines(), f"'{words}' by {n}: {many.stderr} instead of {one.stderr}")
            expect(many.returncode == code, f"'{words}' by {n}: exit {many.returncode}")
            expect(many.stdout == "", f"'{words}' by {n}: {many.stdout}")
            expect(sorted(os.listdir(folder.path)) == before, f"'{words}' by {n}: left files")
    for words, message in (("info donor.bzl", "error: info runs as one process, found 2: start it without mpirun"),
                           ("transfer donor.bzl tiny.msh -o out.bzl --matrix m.mtx --conserve total",
                            "error: --matrix: not with --continuity cg or --conserve total; see "
                            "'bezel transfer --help'")):
        many = folder.run(words, 2)
        ours = [line for line in many.stderr.splitlines() if line.startswith("error: ")]
        expect(ours == [message] and many.returncode == 2, f"'{words}': exit {many.returncode}: {many.stderr}")
        expect(sorted(os.listdir(folder.path)) == before, f"'{words}': left files")


def main():
    mpiexec, flag, bezel, name = sys.argv[1:]
    with tempfile.TemporaryDirectory() as path:
        folder = Folder(path, mpiexec, flag, bezel)
        try:
            if name in CASES:
                compare(folder, *CASES[name])
            else:
                {"matrix": matrix, "series": series, "petsc": petsc, "errors": errors}[name](folder)
        except Failure as failure:
            sys.exit(f"{name}: {failure}")


if __name__ == "__main__":
    main()
