#include "bezel/field/survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "meshes.hpp"

namespace bezel::field_detail {
namespace {

/// Fields with 1, 3, 1, 2, .. components: 18 in all, some of both signs.
std::vector<Field> some_fields(const std::shared_ptr<const Space>& space) {
  RandomStream random("survey", 1);
  std::vector<Field> fields;
  for (const int own : {1, 3, 1, 1, 2, 1, 1, 1, 4, 1, 2}) {
    std::vector<double> c(space->coefficient_count() * static_cast<std::size_t>(own));
    const double shift = 0.15 * static_cast<double>(fields.size());
    for (double& x : c) x = random.uniform() - shift;
    fields.emplace_back("f", space, std::move(c), own);
  }
  return fields;
}

std::vector<std::shared_ptr<const Space>> some_spaces() {
  std::vector<std::shared_ptr<const Space>> spaces;
  for (const int g : {1, 2}) {
    const auto mesh = field_test::wavy(5, g);  // 50 elements: a whole block and a part of one
    std::vector<int> degrees;
    for (std::size_t e = 0; e < mesh->element_count(); ++e)
      degrees.push_back(static_cast<int>(e % 4));
    for (const Basis basis : {Basis::reference, Basis::physical}) {
      for (const int p : {0, 1, 2, 3, 5}) spaces.push_back(Space::discontinuous(mesh, p, basis));
      spaces.push_back(Space::discontinuous(mesh, degrees, basis));
    }
  }
  return spaces;
}

Survey look_at(const Space& space, std::span<const Column> columns, SpaceMeasures& measures,
               int threads) {
  return survey(space, columns,
                {measures.basis_integrals(), &measures.absolute(), &measures.ranges()}, threads);
}

std::vector<const Field*> pointers(const std::vector<Field>& fields) {
  std::vector<const Field*> all;
  for (const Field& f : fields) all.push_back(&f);
  return all;
}

TEST(Survey, OfManyComponentsHasTheBitsOfEachAlone) {
  for (const auto& space : some_spaces()) {
    const std::vector<Field> fields = some_fields(space);
    const std::vector<Column> columns = columns_of(pointers(fields));
    ASSERT_EQ(columns.size(), 18u);
    SpaceMeasures measures(space, 1);
    const Survey all = look_at(*space, columns, measures, 1);
    const Survey threads = look_at(*space, columns, measures, 3);
    EXPECT_EQ(all.integrals, threads.integrals);
    EXPECT_EQ(all.bounds.high, threads.bounds.high);
    const std::size_t elements = space->mesh()->element_count();
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const Survey one = look_at(*space, {&columns[c], 1}, measures, 1);
      for (std::size_t e = 0; e < elements; ++e) {
        EXPECT_EQ(all.integrals[e * columns.size() + c], one.integrals[e]);
        EXPECT_EQ(all.absolute[e * columns.size() + c], one.absolute[e]);
      }
      ASSERT_EQ(one.bounds.high.size(), 2u);
      for (std::size_t b = 0; b < 2; ++b) {
        EXPECT_EQ(all.bounds.high[b * columns.size() + c], one.bounds.high[b]);
        EXPECT_EQ(all.bounds.low[b * columns.size() + c], one.bounds.low[b]);
        EXPECT_EQ(all.bounds.slack[b * columns.size() + c], one.bounds.slack[b]);
      }
    }
  }
}

TEST(Survey, FindsIntegralsAndBoundsOfTheValues) {
  for (const auto& space : some_spaces()) {
    const std::vector<Field> fields = some_fields(space);
    const std::vector<Column> columns = columns_of(pointers(fields));
    SpaceMeasures measures(space, 1);
    const Survey all = look_at(*space, columns, measures, 1);
    const std::span<const double> basis = measures.basis_integrals();
    std::size_t first = 0;
    for (const Field& f : fields) {
      const auto own = static_cast<std::size_t>(f.components());
      std::vector<double> value(own);
      for (std::size_t e = 0; e < space->mesh()->element_count(); ++e) {
        const ElementId id(e);
        const auto c = f.coefficients(id);
        for (std::size_t k = 0; k < own; ++k) {
          double expected = 0.0, size = 0.0;
          for (std::size_t n = 0; n * own < c.size(); ++n) {
            const double part = basis[space->offset(id) + n] * c[n * own + k];
            expected += part;
            size += std::abs(part);
          }
          const std::size_t place = e * columns.size() + first + k;
          EXPECT_NEAR(all.integrals[place], expected, 1e-14 * size);
          EXPECT_GE(all.absolute[place], std::abs(all.integrals[place]) - 1e-13 * size);
          EXPECT_LE(all.absolute[place], size * (1.0 + 1e-12));
        }
        for (int n = 0; n < bernstein::triangle_size(6); ++n) {
          const auto at = bernstein::triangle_multi_index(6, n);
          f.evaluate(id, {at[0] / 6.0, at[1] / 6.0, at[2] / 6.0}, value);
          for (std::size_t k = 0; k < own; ++k) {
            const std::size_t block = e / BlockBounds::block * columns.size() + first + k;
            EXPECT_GE(value[k], all.bounds.low[block] - 1e-13);
            EXPECT_LE(value[k], all.bounds.high[block] + 1e-13);
          }
        }
      }
      first += own;
    }
  }
}

TEST(Survey, ShowsEachCoefficientOnce) {
  for (const auto& space : some_spaces()) {
    const std::vector<Field> fields = some_fields(space);
    const std::vector<Column> columns = columns_of(pointers(fields));
    std::vector<int> seen(space->coefficient_count() * columns.size(), 0);
    std::mutex guard;
    const Survey found = survey(*space, columns, {}, 2, [&](const SurveyBlock& block) {
      const std::lock_guard lock(guard);
      const std::size_t begin = space->offset(ElementId(block.from)),
                        end = block.to < space->mesh()->element_count()
                                  ? space->offset(ElementId(block.to))
                                  : space->coefficient_count();
      for (std::size_t n = begin; n < end; ++n) {
        for (std::size_t k = 0; k < block.count; ++k) {
          const Column& column = columns[block.first + k];
          EXPECT_EQ(block.c[(n - begin) * block.width + k], column.first[n * column.stride]);
          ++seen[n * columns.size() + block.first + k];
        }
      }
    });
    EXPECT_TRUE(found.integrals.empty());
    EXPECT_TRUE(found.bounds.high.empty());
    EXPECT_EQ(std::ranges::count(seen, 1), std::ssize(seen));
  }
}

TEST(Survey, CopiesTheFirstNumbersOfRows) {
  constexpr std::size_t rows = 3, from_stride = 11, to_stride = 9;
  std::vector<double> from(rows * from_stride);
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = static_cast<double>(i);
  for (std::size_t count = 1; count <= lanes; ++count) {
    std::vector<double> to(rows * to_stride, -1.0);
    copy_rows(rows, count, from.data(), from_stride, to.data(), to_stride);
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t k = 0; k < to_stride; ++k)
        EXPECT_EQ(to[r * to_stride + k], k < count ? from[r * from_stride + k] : -1.0) << count;
  }
}

TEST(Ranges, FromASurveyAreThoseOfTheField) {
  for (const auto& space : some_spaces()) {
    const std::vector<Field> fields = some_fields(space);
    SpaceMeasures measures(space, 1);
    const Survey all = look_at(*space, columns_of(pointers(fields)), measures, 1);
    std::size_t place = 0;
    for (const Field& f : fields) {
      for (int c = 0; c < f.components(); ++c, ++place) {
        const auto alone = measures.ranges()(f, c);
        const auto found = measures.ranges()(f, c, all.bounds, place);
        EXPECT_EQ(alone.lo, found.lo);
        EXPECT_EQ(alone.hi, found.hi);
      }
    }
  }
}

}  // namespace
}  // namespace bezel::field_detail
