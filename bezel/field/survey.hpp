#pragma once
// Internal: what is read off the coefficients of many fields of one space, in one look at them.

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "bezel/field/element_range.hpp"
#include "bezel/field/integrals.hpp"
#include "bezel/field/survey_lanes.hpp"

namespace bezel::field_detail {

/// Elements that are looked at together, and components side by side.
inline constexpr std::size_t survey_block = BlockBounds::block, survey_width = lanes;

/// One component of a field: its coefficients are `stride` apart.
struct Column {
  const double* first;
  std::size_t stride;
};

/// Copies the first `count` numbers, at most eight, of rows that are some stride apart.
void copy_rows(std::size_t rows, std::size_t count, const double* from, std::size_t from_stride,
               double* to, std::size_t to_stride);

/// The components of some fields, one field after the other.
std::vector<Column> columns_of(std::span<const Field* const> fields);

/// Some components on elements from..to of one block.
struct SurveyBlock {
  std::size_t from, to;
  std::size_t first, count;  ///< components; count <= width
  std::size_t width;         ///< 1 or survey_width
  const double* c;           ///< coefficients of these elements, shape (coefficients, width)
};

/// What is looked for; null or empty: not that.
struct SurveyAim {
  std::span<const double> basis_integrals;
  const AbsIntegral* absolute = nullptr;  ///< needs the integrals
  const ValueRanges* ranges = nullptr;
};

struct Survey {
  std::vector<double> integrals;  ///< over elements, shape (elements, components)
  std::vector<double> absolute;   ///< of absolute values, the same shape
  BlockBounds bounds;
};

/// Room for what is looked for.
Survey make_survey(const Space& space, std::size_t components, const SurveyAim& aim);

/// What one thread needs, kept from block to block.
struct SurveyRoom {
  LaneSurvey found;
  std::vector<double> points;  // for integrals of |f|
};

/// Looks at one block. May be called for several blocks at once.
void look(const Space& space, const SurveyAim& aim, const SurveyBlock& block, Survey& survey,
          SurveyRoom& room);

/// Looks at all elements.
/// @param visit  called after each look, by several threads at once
Survey survey(const Space& space, std::span<const Column> columns, const SurveyAim& aim,
              int threads = 0, const std::function<void(const SurveyBlock&)>& visit = {});

/// What surveys of fields of one space need; it depends on the elements only, and each part is made
/// when it is first asked for, by one thread.
class SpaceMeasures {
 public:
  SpaceMeasures(std::shared_ptr<const Space> space, int threads)
      : space_(std::move(space)), threads_(threads) {}
  const std::shared_ptr<const Space>& space() const { return space_; }
  std::span<const double> basis_integrals();
  const AbsIntegral& absolute();
  const ValueRanges& ranges();

 private:
  std::shared_ptr<const Space> space_;
  int threads_;
  std::vector<double> basis_integrals_;
  std::unique_ptr<AbsIntegral> absolute_;
  std::unique_ptr<ValueRanges> ranges_;
};

}  // namespace bezel::field_detail
