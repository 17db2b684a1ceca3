#pragma once
// Fields of JSON objects, checked as they are read, with errors that say where.

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "cli/json_text.hpp"

namespace bezel::cli {

/// Reads values of one file. `where` names the place in messages: "curve 1, point 2".
class JsonFields {
 public:
  explicit JsonFields(std::string file) : file_(std::move(file)) {}

  /// @throws InputError with file, line and place, as all functions here
  [[noreturn]] void fail(const JsonValue& at, const std::string& where,
                         const std::string& message) const;
  void check_object(const JsonValue& value, const std::string& where) const;
  void check_keys(const JsonValue& object, const std::string& where,
                  std::initializer_list<const char*> known) const;
  const JsonValue& required(const JsonValue& object, const std::string& where,
                            const char* key) const;
  /// A finite JSON number, or a string that parse_number reads.
  double number(const JsonValue& value, const std::string& where);
  std::vector<double> numbers(const JsonValue& list, const std::string& where);
  /// A whole number from least to most. @param what  names it: "degree"
  int whole(const JsonValue& value, const std::string& where, const char* what, int least,
            int most) const;
  bool boolean(const JsonValue& value, const std::string& where, const char* what) const;
  const std::string& string(const JsonValue& value, const std::string& where,
                            const char* what) const;
  /// [[x, ...], [y, ...]], of `least` to `most` coordinates; all of one length. Places of numbers
  /// are "point 2".
  std::vector<std::vector<double>> coordinates(const JsonValue& lists, const std::string& where,
                                               std::size_t least, std::size_t most);

  const std::string& file() const { return file_; }
  /// How many rationals were no doubles and were rounded.
  std::size_t rounded() const { return rounded_; }

 private:
  std::string file_;
  std::size_t rounded_ = 0;
};

}  // namespace bezel::cli
