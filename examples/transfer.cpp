// Reads two meshes, puts a field on the first, moves it to the second, says what happened, and
// writes the result.
#include <array>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "bezel/field/field.hpp"
#include "bezel/io/io.hpp"
#include "bezel/transfer/transfer.hpp"

int main(int argc, char** argv) try {
  using namespace bezel;
  if (argc != 4) {
    std::fprintf(stderr, "usage: example_transfer DONOR.msh TARGET.msh OUT.vtu\n");
    return 2;
  }
  const Dataset donor = read(argv[1]);
  const Dataset target = read(argv[2]);

  // A cubic field on the donor mesh: the flow speed in the channel.
  const auto space = Space::discontinuous(donor.mesh, 3);
  const Field speed = project("speed", space, std::array{Formula("7.14 * y * (0.41 - y)")});

  // Each mesh draws the cylinder with its own arcs, so slivers of the target lie outside the donor:
  // extend into them.
  TransferOptions options;
  options.uncovered = Uncovered::extend;
  const TransferResult moved = transfer(std::array{speed}, target.mesh, options);

  const FieldReport& mass = moved.report.fields[0];
  std::printf("mass before   %.12g\n", mass.mass_before);
  std::printf("  outside     %.3g\n", mass.mass_outside);
  std::printf("  made        %.3g\n", mass.mass_made);
  std::printf("mass after    %.12g\n", mass.mass_after);
  std::printf("conserved     %s\n", mass.relative_mass_defect < 1e-14 ? "yes" : "no");
  std::printf("largest value %.4f\n", mass.max_after);

  for (const std::string& lost : write(argv[3], Dataset{target.mesh, moved.fields, {}}))
    std::printf("note: %s\n", lost.c_str());
  return mass.relative_mass_defect < 1e-14 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 3;
}
