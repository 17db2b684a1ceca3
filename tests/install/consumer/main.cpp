// Every kind of module in one program: meshes, formula, field, transfer, files, picture.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "bezel/field/field.hpp"
#include "bezel/io/io.hpp"
#include "bezel/mesh/generate.hpp"
#include "bezel/transfer/transfer.hpp"
#include "bezel/view/draw.hpp"

int main() {
  bezel::GenerateOptions fine, coarse;
  fine.degree = 3;
  fine.size = 0.4;
  coarse.size = 0.7;
  const auto donor_mesh =
      std::make_shared<const bezel::TriangleMesh>(bezel::generate_rectangle(3, 3, coarse));
  const auto target_mesh =
      std::make_shared<const bezel::TriangleMesh>(bezel::generate_disc(1, fine));

  const std::array<bezel::Formula, 1> formula{bezel::Formula("exp(x^2) + 2*y")};
  const bezel::Field donor =
      bezel::sample("u", bezel::Space::discontinuous(donor_mesh, 3), formula);
  const bezel::TransferResult result = bezel::transfer(std::array{donor}, target_mesh);

  const auto folder = std::filesystem::temp_directory_path();
  const std::string file = (folder / "bezel-consumer.vtu").string();
  bezel::write(file, {.mesh = target_mesh, .fields = result.fields, .time = {}});
  const bezel::Dataset back = bezel::read(file);
  std::filesystem::remove(file);
  const std::string picture = (folder / "bezel-consumer.png").string();
  bezel::draw(picture,
              {{.layers = {{.mesh = target_mesh, .field = back.field("u"), .line_colour = ""}},
                .title = "u"}});
  std::filesystem::remove(picture);

  const bezel::FieldReport& report = result.report.fields[0];
  if (report.relative_mass_defect > 1e-14) return 1;
  std::printf("conserved %.15g\n", bezel::integral(back.field("u"))[0]);
}
