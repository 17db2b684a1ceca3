#pragma once
// Reading back what was drawn.

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/view/colour.hpp"
#include "support/message_of.hpp"

namespace bezel::test {

struct Image {
  explicit Image(const std::string& path) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << path;
    image.format = PNG_FORMAT_RGB;
    width = static_cast<int>(image.width);
    height = static_cast<int>(image.height);
    bytes.resize(PNG_IMAGE_SIZE(image));
    EXPECT_NE(png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr), 0);
  }
  std::array<int, 3> at(int x, int y) const {
    const auto i = static_cast<std::size_t>(3 * (y * width + x));
    return {bytes[i], bytes[i + 1], bytes[i + 2]};
  }
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};

inline int difference(const std::array<int, 3>& a, const view::Colour& b) {
  const std::array<double, 3> parts = {b.r, b.g, b.b};
  int largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    largest = std::max(largest, std::abs(a[k] - static_cast<int>(std::lround(255.0 * parts[k]))));
  }
  return largest;
}

inline std::string scratch(const std::string& name) {
  const auto folder =
      std::filesystem::temp_directory_path() /
      ("bezel_view_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

}  // namespace bezel::test
