#pragma once
// Internal to io: an XML document and messages about it; only for .cpp files (heavy header).

#include <cstdint>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>

namespace bezel::files {

class Xml {
 public:
  /// @param bytes  the file, for line numbers
  Xml(std::string path, std::string_view bytes) : path_(std::move(path)), bytes_(bytes) {}

  /// @param xml  the XML part of the file, which begins where the file begins
  /// @throws InputError when it cannot be read
  void parse(std::string_view xml);

  const pugi::xml_document& document() const { return document_; }
  std::int64_t line(const pugi::xml_node& node) const;
  /// The element of that name. @throws InputError when there is none
  pugi::xml_node child(const pugi::xml_node& node, const char* name) const;
  [[noreturn]] void fail(std::int64_t at_line, const std::string& message) const;

 private:
  std::string path_;
  std::string_view bytes_;
  pugi::xml_document document_;
};

}  // namespace bezel::files
