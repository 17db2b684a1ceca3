#include "bezel/io/xml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "bezel/base/error.hpp"
#include "bezel/io/cursor.hpp"

namespace bezel::files {

void Xml::parse(std::string_view xml) {
  const pugi::xml_parse_result result = document_.load_buffer(xml.data(), xml.size());
  if (!result) {
    std::string reason = result.description();
    if (!reason.empty()) reason[0] = static_cast<char>(std::tolower(reason[0]));
    fail(line_of(bytes_, static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0))),
         "the XML cannot be read: " + reason);
  }
}

std::int64_t Xml::line(const pugi::xml_node& node) const {
  const std::ptrdiff_t offset = node.offset_debug();
  return offset < 0 ? 0 : line_of(bytes_, static_cast<std::size_t>(offset));
}

pugi::xml_node Xml::child(const pugi::xml_node& node, const char* name) const {
  const pugi::xml_node found = node.child(name);
  if (!found)
    fail(line(node), fmt::format("{} has no {} element, expected one", node.name(), name));
  return found;
}

void Xml::fail(std::int64_t at_line, const std::string& message) const {
  InputPlace place;
  place.file = path_;
  place.line = at_line;
  throw InputError(place, message);
}

}  // namespace bezel::files
