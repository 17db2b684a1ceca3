// Seeded mutations of valid files of every format through the readers.

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "bezel/io/msh.hpp"
#include "bezel/io/native.hpp"
#include "bezel/io/pvd.hpp"
#include "bezel/io/vtu.hpp"
#include "tests/fuzz/io_fuzz.hpp"
#include "tests/fuzz/try_many.hpp"
#include "tests/unit/io/datasets.hpp"

namespace bezel {
namespace {

struct Seed {
  std::string name, bytes;
  int format;
};

std::vector<Seed> seeds() {
  std::vector<Seed> all;
  for (const int g : {1, 3}) {
    Dataset data;
    const auto mesh = io_test::tagged_disc(g, 2.0);
    data.mesh = mesh;
    data.time = 0.1;
    data.fields = {
        io_test::wavy("nodal", Space::continuous(mesh, g), 2),
        io_test::wavy("jumps", Space::discontinuous(
                                   mesh, io_test::varying_degrees(mesh->element_count(), 0, 2))),
        io_test::wavy("physical", Space::discontinuous(mesh, 1, Basis::physical)),
        io_test::wavy("cells", Space::discontinuous(mesh, 0))};
    std::vector<std::string> lost;
    for (const Format f :
         {Format::msh22_ascii, Format::msh22_binary, Format::msh41_ascii, Format::msh41_binary})
      all.push_back({to_string(f), files::write_msh(data, f, lost), 0});
    for (const bool bezier : {false, true})
      all.push_back({"vtu", files::write_vtu(data, {{}, bezier, !bezier}, lost), 1});
    all.push_back({"native", files::write_native(data), 2});
  }
  all.push_back(
      {"pvd", encode_pvd({{0.0, "run_0.vtu"}, {0.5, "run_1.vtu"}, {1e-3, "folder/run_2.vtu"}}), 3});
  // Text arrays and raw appended data, which the writer does not use.
  const char* const cells =
      "<Cells><DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 1 3 2</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\">3 6</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\">5 69</DataArray></Cells>";
  const std::string head =
      "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"><UnstructuredGrid>"
      "<Piece NumberOfPoints=\"4\" NumberOfCells=\"2\">";
  const std::string tail = std::string(cells) +
                           "<PointData><DataArray type=\"Float32\" Name=\"u\">1 2 3.5 4e-1"
                           "</DataArray></PointData></Piece></UnstructuredGrid>";
  all.push_back({"vtu text",
                 head +
                     "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 "
                     "1 0 1 1 0</DataArray></Points>" +
                     tail + "</VTKFile>",
                 1});
  std::string raw("\x30\0\0\0", 4);
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 1.F, 1.F, 0.F})
    raw.append(reinterpret_cast<const char*>(&x), 4);
  all.push_back({"vtu raw",
                 head +
                     "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
                     "format=\"appended\" offset=\"0\"/></Points>" +
                     tail + "<AppendedData encoding=\"raw\">_" + raw + "</AppendedData></VTKFile>",
                 1});
  return all;
}

/// One to eight changes: bytes, bits, numbers, cuts, copies.
std::string mutate(std::string bytes, RandomStream& random) {
  static const std::vector<std::string> numbers{
      "0",  "-1", "1",  "2147483648",         "1e999", "nan",
      "99", "$",  "\"", "999999999999999999", "inf",   "\n"};
  const std::uint64_t changes = 1 + random.below(8);
  for (std::uint64_t c = 0; c < changes && !bytes.empty(); ++c) {
    const auto place = static_cast<std::size_t>(random.below(bytes.size()));
    switch (random.below(7)) {
      case 0:
        bytes[place] = static_cast<char>(random.below(256));
        break;
      case 1:
        bytes[place] = static_cast<char>(bytes[place] ^ (1 << random.below(8)));
        break;
      case 2:
        bytes.insert(place, numbers[random.below(numbers.size())]);
        break;
      case 3: {  // replace a word
        const std::size_t start = bytes.find_first_of(" \n\"", place);
        if (start == std::string::npos) break;
        const std::size_t end = std::min(bytes.find_first_of(" \n\"", start + 1), bytes.size());
        bytes.replace(start + 1, end - start - 1, numbers[random.below(numbers.size())]);
        break;
      }
      case 4:
        bytes.erase(place, 1 + random.below(16));
        break;
      case 5: {
        const std::string copy = bytes.substr(place, 1 + random.below(64));
        bytes.insert(static_cast<std::size_t>(random.below(bytes.size())), copy);
        break;
      }
      default:  // a large value in binary data
        for (std::size_t i = place; i < std::min(place + 8, bytes.size()); ++i)
          bytes[i] = random.below(2) == 0 ? '\xff' : '\x7f';
    }
  }
  return bytes;
}

TEST(IoMutations, OriginalsAreRead) {
  for (const Seed& seed : seeds())
    EXPECT_TRUE(io_fuzz::read_bytes(seed.bytes, seed.format)) << seed.name;
}

TEST(IoMutations, EveryTruncationIsAnInputError) {
  for (const Seed& seed : seeds()) {
    SCOPED_TRACE(seed.name);
    // What comes after the last thing that is read may be cut.
    const std::size_t step = std::max<std::size_t>(1, seed.bytes.size() / 150);
    std::size_t read = 0, tried = 0;
    for (std::size_t n = 0; n < seed.bytes.size() - 32; n += step, ++tried)
      read += io_fuzz::read_bytes(seed.bytes.substr(0, n), seed.format) ? 1 : 0;
    // An MSH file cut exactly between two sections is whole; anything else is not.
    EXPECT_LE(read, seed.format == 0 ? 2U : 0U) << "of " << tried;
  }
}

TEST(IoMutations, MutatedFilesAreReadOrRefused) {
  const std::vector<Seed> all = seeds();
  constexpr std::uint64_t number = 20240517;
  RandomStream random("io mutations", number);
  std::size_t next = 0;
  struct Input {
    const Seed& seed;
    std::string bytes;
  };
  fuzz::try_many(
      {20000, std::chrono::seconds(3), 0.25, 0.0},
      [&] {
        const Seed& seed = all[next++ % all.size()];
        return Input{seed, mutate(seed.bytes, random)};
      },
      [](const Input& in) { return io_fuzz::read_bytes(in.bytes, in.seed.format); },
      [](const Input& in) {
        io_test::spill("io-mutation-crash", in.bytes);
        return in.seed.name + " (saved as io-mutation-crash), of seed " + std::to_string(number);
      });
}

}  // namespace
}  // namespace bezel
