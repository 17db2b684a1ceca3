#pragma once
// Reads the reference data of tests/reference/data/bezier.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace support {

inline nlohmann::json load_reference(const std::string& name) {
  std::ifstream in(std::string(BEZEL_REFERENCE_DATA) + "/" + name);
  EXPECT_TRUE(in.good()) << name;
  return nlohmann::json::parse(in);
}

/// A JSON number, "p/q", or a hex float.
inline double reference_number(const nlohmann::json& j) {
  if (j.is_number()) return j.get<double>();
  const std::string text = j.get<std::string>();
  const auto slash = text.find('/');
  if (slash == std::string::npos) return std::strtod(text.c_str(), nullptr);
  return std::strtod(text.substr(0, slash).c_str(), nullptr) /
         std::strtod(text.substr(slash + 1).c_str(), nullptr);
}

/// The control points of a shape: a list of x and one of y.
inline std::vector<bezel::Vec2> reference_control(const nlohmann::json& shapes,
                                                  const std::string& id) {
  const nlohmann::json& points = shapes.at(id).at("control_points");
  std::vector<bezel::Vec2> control;
  for (std::size_t i = 0; i < points.at(0).size(); ++i)
    control.push_back(
        bezel::Vec2{{reference_number(points.at(0).at(i)), reference_number(points.at(1).at(i))}});
  return control;
}

}  // namespace support
