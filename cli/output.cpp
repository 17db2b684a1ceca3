#include "cli/output.hpp"
#include "bezel/base/error.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/parallel.hpp"

namespace bezel::cli {

void print(std::string_view text) {
  const bool written =
      std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written) {
    std::string reason = std::generic_category().message(errno);
    if (!reason.empty())
      reason[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(reason[0])));
    throw InputError(InputPlace{"standard output", 0, {}, -1}, "cannot be written: " + reason);
  }
}

void print_or_remove(std::string_view text, const std::vector<std::string>& files) {
  try {
    print(text);
  } catch (...) {
    std::error_code ignored;
    for (const std::string& file : files) std::filesystem::remove(file, ignored);
    throw;
  }
}

std::string to_text(const Json& object) {
  // File names need not be UTF-8.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void print_json(const Json& object) {
  print(to_text(object));
}

void note(const Context& context, std::string_view message) {
  if (!context.quiet) fmt::print(stderr, "note: {}\n", message);
}

void notes(const Context& context, const std::string& file,
           const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) note(context, file + ": " + sentence);
}

Dataset read_noting(const Context& context, const std::string& path,
                    const std::optional<Format>& format) {
  ReadOptions options;
  options.format = format;
  Dataset data = read(path, options);
  notes(context, path, data.notes);
  return data;
}

std::vector<Dataset> read_all_noting(const Context& context, std::span<const std::string> paths) {
  std::vector<Dataset> data(paths.size());
  parallel_for(
      paths.size(), [&](std::size_t i) { data[i] = read(paths[i]); }, context.threads);
  for (std::size_t i = 0; i < paths.size(); ++i) notes(context, paths[i], data[i].notes);
  return data;
}

void require_writable(const std::string& path) {
  const AtomicFile attempt(path);
}

Json per_component(const std::vector<double>& values) {
  return values.size() == 1 ? Json(values[0]) : Json(values);
}

std::string counted(std::size_t n, std::string_view singular) {
  return fmt::format("{} {}{}", n, singular, n == 1 ? "" : "s");
}

}  // namespace bezel::cli
