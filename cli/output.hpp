#pragma once
// Data on the standard output, messages on the standard error.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bezel/io/io.hpp"
#include "cli/context.hpp"

namespace bezel::cli {

using Json = nlohmann::ordered_json;

/// Writes text to the standard output. @throws InputError when it cannot be written
void print(std::string_view text);
/// The same for a command that has written files: they are removed when the text cannot be written,
/// since a command that fails leaves none.
void print_or_remove(std::string_view text, const std::vector<std::string>& files);
/// Prints one JSON object; numbers round-trip, NaN and infinity become null.
void print_json(const Json& object);
/// The text print_json(object) writes.
std::string to_text(const Json& object);

/// "note: ..." on the standard error, unless --quiet.
void note(const Context& context, std::string_view message);
/// One note per sentence, with the file's name in front.
void notes(const Context& context, const std::string& file,
           const std::vector<std::string>& sentences);

/// Reads a file and notes what was not kept.
Dataset read_noting(const Context& context, const std::string& path,
                    const std::optional<Format>& format = {});

/// Reads several files at the same time; notes and errors come in their order.
std::vector<Dataset> read_all_noting(const Context& context, std::span<const std::string> paths);

/// Fails now, before the work, when a file cannot be written later.
/// @throws InputError
void require_writable(const std::string& path);

/// Values of a field's components: a number for a scalar field, an array otherwise.
Json per_component(const std::vector<double>& values);

/// "1 triangle", "2 triangles".
std::string counted(std::size_t n, std::string_view singular);

}  // namespace bezel::cli
