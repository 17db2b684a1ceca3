#include "bezel/view/ticks.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace bezel::view {
namespace {

// A number with just the digits that its step needs; "1e-5" style far from one.
std::string label(double value, double step) {
  if (value == 0.0) return "0";
  char text[64];
  const double size = std::max(std::abs(value), step);
  if (size >= 1e6 || step < 1e-5) {
    const int digits = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9)) -
                       static_cast<int>(std::floor(std::log10(step) + 1e-9)) + 1;
    const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific,
                                   std::clamp(digits, 0, 14))
                         .ptr;
    const std::string s(text, end);
    const std::size_t e = s.find('e');
    std::string mantissa = s.substr(0, e);
    if (mantissa.find('.') != std::string::npos) {
      mantissa.erase(mantissa.find_last_not_of('0') + 1);
      if (mantissa.back() == '.') mantissa.pop_back();
    }
    return mantissa + "e" + std::to_string(std::stoi(s.substr(e + 1)));
  }
  int decimals = 0;
  for (double scaled = step; decimals < 9 && std::abs(scaled - std::round(scaled)) > 1e-6 * scaled;
       ++decimals)
    scaled *= 10.0;
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr;
  return std::string(text, end);
}

// A typographic minus.
std::string with_minus(std::string text) {
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos;)
    text.replace(at, 1, "\xe2\x88\x92");
  return text;
}

}  // namespace

Ticks linear_ticks(double lo, double hi, int count) {
  const double raw = (hi - lo) / std::max(count, 1);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  int parts = 5;
  for (const auto& [factor, minor_parts] : {std::pair{1.0, 5}, {2.0, 4}, {2.5, 5}, {5.0, 5}}) {
    if (factor * power >= raw * (1.0 - 1e-9)) {
      step = factor * power;
      parts = minor_parts;
      break;
    }
  }
  Ticks ticks;
  const double slack = 1e-9 * (hi - lo);
  const double first = std::ceil((lo - slack) / step), last = std::floor((hi + slack) / step);
  for (double k = first; k <= last && ticks.major.size() < 100; k += 1.0) {
    const double value = k * step;
    ticks.major.push_back(std::clamp(value, lo, hi));
    ticks.labels.push_back(with_minus(label(value, step)));
    ticks.superscripts.emplace_back();
  }
  const double fine = step / parts;
  const double fine_first = std::ceil((lo - slack) / fine),
               fine_last = std::floor((hi + slack) / fine);
  for (double k = fine_first; k <= fine_last && ticks.minor.size() < 500; k += 1.0)
    if (std::fmod(k, parts) != 0.0) ticks.minor.push_back(std::clamp(k * fine, lo, hi));
  return ticks;
}

Ticks log_ticks(double lo, double hi, int count) {
  Ticks ticks;
  const double slack = 1e-9;
  const double low = std::log10(lo), high = std::log10(hi);
  const int first = static_cast<int>(std::ceil(low - slack)),
            last = static_cast<int>(std::floor(high + slack));
  const int every = std::max(1, (last - first + count) / std::max(count, 1));
  const auto power = [](int k) { return std::pow(10.0, k); };
  const auto add = [&](double value, std::string text, std::string superscript) {
    ticks.major.push_back(std::clamp(value, lo, hi));
    ticks.labels.push_back(std::move(text));
    ticks.superscripts.push_back(with_minus(std::move(superscript)));
  };
  const bool short_range = high - low < 2.0;
  for (int k = first - 1; k <= last; ++k) {
    const bool labelled = k % every == 0;
    if (k >= first) {
      if (labelled) {
        add(power(k), "10", std::to_string(k));
      } else {
        ticks.minor.push_back(std::clamp(power(k), lo, hi));
      }
    }
    for (int m = 2; m <= 9 && every == 1; ++m) {
      const double value = m * power(k);
      if (value < lo * (1.0 - slack) || value > hi * (1.0 + slack)) continue;
      if (short_range && (m == 2 || m == 5)) {
        add(value,
            std::to_string(m) +
                "\xc3\x97"
                "10",
            std::to_string(k));
      } else {
        ticks.minor.push_back(std::clamp(value, lo, hi));
      }
    }
  }
  // A range between two labels (such as 3 to 4): ordinary numbers.
  if (ticks.major.size() < 2) return linear_ticks(lo, hi, count);
  return ticks;
}

}  // namespace bezel::view
