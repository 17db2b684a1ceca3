#pragma once
// Internal: masses and ranges of many fields for the report.

#include <memory>
#include <span>
#include <vector>

#include "bezel/field/survey.hpp"
#include "bezel/transfer/transfer.hpp"

namespace bezel::detail {

/// Fields of one space that became fields of one space, and what is known of their components,
/// which are numbered one field after the other.
struct MovedFields {
  std::span<const Field*const> donors, moved;
  std::span<const double> outside, made, spread;  ///< masses
  std::span<const double> element_defect;         ///< largest |element mass - mass received|
  /// Of the donors with integrals of |f|, and of what they became; null: not known.
  const field_detail::Survey *before = nullptr, *after = nullptr;
};

/// The lines of a report, one per component of a field that was moved. What depends on the elements
/// only (integrals of basis functions, where elements lie in their frames) is done once per space,
/// and ranges are sought by all threads at the end.
class Reports {
 public:
  /// @param fields  how many donor fields there are: their lines come in that order
  Reports(std::size_t fields, int threads) : lines_(fields), threads_(threads) {}

  /// Saves the work where a space has been measured already.
  void know(std::shared_ptr<field_detail::SpaceMeasures> measures);
  field_detail::SpaceMeasures& measures(const std::shared_ptr<const Space>& space);

  /// Adds the lines of some fields; they must stay where they are until finish().
  /// @param places  numbers of the fields
  void add(std::span<const std::size_t> places, const MovedFields& fields);
  /// A line whose masses are known.
  void add(std::size_t place, const Field& donor, const Field& moved, FieldReport line);

  /// The lines of a field, to be completed.
  std::span<FieldReport> lines(std::size_t place) { return lines_[place]; }

  /// All lines, with their ranges: the narrower of what add()'s caller set and what is found.
  std::vector<FieldReport> finish();

 private:
  /// A range that is sought, and what is known of it.
  struct Sought {
    const Field* field;
    std::shared_ptr<const field_detail::BlockBounds> bounds;  // null: nothing is known
    std::size_t number;                                       // of the component there
    std::size_t place = 0, line = 0;
    bool before = false;
  };
  void seek(std::size_t place, FieldReport line, Sought before, Sought after);

  std::vector<std::vector<FieldReport>> lines_;
  std::vector<Sought> sought_;
  std::vector<std::shared_ptr<field_detail::SpaceMeasures>> measures_;
  int threads_;
};

}  // namespace bezel::detail
