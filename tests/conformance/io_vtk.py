"""VTK's side of the conformance tests of .vtu files; exits with 77 when VTK is not installed.

usage: io_vtk.py available
       io_vtk.py check [FILE.vtu EXPECTED]... positions and fields at points of every triangle, to 1e-12
       io_vtk.py copy FILE.vtu FOLDER         the file written again in every encoding of VTK
"""

import sys

try:
    import vtk
except ImportError:
    sys.exit(77)


def load(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def check(path, expected_path):
    """Lines of the expected file: cell u v x y, then name components values... for each field."""
    grid = load(path)
    worst = 0.0
    lines = 0
    for line in open(expected_path):
        words = line.split()
        cell_id, parameters = int(words[0]), [float(words[1]), float(words[2]), 0.0]
        cell = grid.GetCell(cell_id)
        weights = [0.0] * cell.GetNumberOfPoints()
        x, sub = [0.0] * 3, vtk.reference(0)
        cell.EvaluateLocation(sub, parameters, x, weights)
        worst = max(worst, abs(x[0] - float(words[3])), abs(x[1] - float(words[4])), abs(x[2]))
        position = 5
        while position < len(words):
            name, components = words[position], int(words[position + 1])
            values = [float(w) for w in words[position + 2:position + 2 + components]]
            position += 2 + components
            array = grid.GetPointData().GetArray(name)
            for c in range(components):
                if array is None:
                    found = grid.GetCellData().GetArray(name).GetComponent(cell_id, c)
                else:
                    found = sum(w * array.GetComponent(cell.GetPointId(i), c) for i, w in enumerate(weights))
                worst = max(worst, abs(found - values[c]))
        lines += 1
    print(f"{path}: {lines} points, largest difference {worst:.2e}")
    return 0 if lines > 0 and worst <= 1e-12 else 1


def copy(path, folder):
    grid = load(path)
    number = 0
    for mode in ("ascii", "binary", "base64", "raw"):
        for compress in (False, True):
            for header in (32, 64):
                for big_endian in (False, True):
                    writer = vtk.vtkXMLUnstructuredGridWriter()
                    writer.SetInputData(grid)
                    writer.SetFileName(f"{folder}/copy{number}.vtu")
                    number += 1
                    if mode == "ascii":
                        writer.SetDataModeToAscii()
                    elif mode == "binary":
                        writer.SetDataModeToBinary()
                    else:
                        writer.SetDataModeToAppended()
                        writer.SetEncodeAppendedData(mode == "base64")
                    if not compress:
                        writer.SetCompressorTypeToNone()
                    else:
                        writer.SetCompressorTypeToZLib()
                        writer.SetBlockSize(1 << 10)
                    if header == 32:
                        writer.SetHeaderTypeToUInt32()
                    else:
                        writer.SetHeaderTypeToUInt64()
                    if big_endian:
                        writer.SetByteOrderToBigEndian()
                    else:
                        writer.SetByteOrderToLittleEndian()
                    if not writer.Write():
                        return 1
    return 0


if __name__ == "__main__":
    command = sys.argv[1]
    if command == "available":
        sys.exit(0)
    if command == "check":
        sys.exit(max([check(*pair) for pair in zip(sys.argv[2::2], sys.argv[3::2])]))
    sys.exit(copy(sys.argv[2], sys.argv[3]))
