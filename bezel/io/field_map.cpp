#include "bezel/io/field_map.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "bezel/base/error.hpp"
#include "bezel/base/parallel.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::files {
namespace {

using bernstein::Lambda;
using bernstein::triangle_multi_index;
using bernstein::triangle_size;
using short_names::at;

constexpr double believable = 1e-8;  // relative; rounding of all conversions stays below 1e-10

Lambda lattice_point(int d, int n) {
  const auto index = triangle_multi_index(d, n);
  const double degree = d;
  return {index[0] / degree, index[1] / degree, index[2] / degree};
}

std::vector<double> component(std::span<const double> interleaved, int c, int components) {
  std::vector<double> out(interleaved.size() / at(components));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = interleaved[i * at(components) + at(c)];
  return out;
}

double largest(std::span<const double> values) {
  double m = 0.0;
  for (const double v : values) m = std::max(m, std::abs(v));
  return m;
}

std::vector<double> raise_or_reduce(int from, std::vector<double> b, int to) {
  if (to > from) return bernstein::elevate<double>(from, b, to - from);
  if (to < from) return bernstein::reduce<double>(from, b, from - to);
  return b;
}

/// Reduces an element's coefficients; nothing when they are not of that degree.
std::optional<std::vector<double>> reduce_exactly(int from, const std::vector<double>& b, int to,
                                                  double scale) {
  std::vector<double> reduced = raise_or_reduce(from, b, to);
  const std::vector<double> back = raise_or_reduce(to, reduced, from);
  for (std::size_t i = 0; i < b.size(); ++i)
    if (!(std::abs(back[i] - b[i]) <= believable * scale)) return std::nullopt;
  return reduced;
}

/// The polynomial in x and y whose composition with the element's map has the coefficients b.
std::optional<std::vector<double>> fit_physical(std::span<const Vec2> control, int g, int from,
                                                const std::vector<double>& b, const Frame& frame,
                                                int to, double scale) {
  // Values on a lattice of the mapped degree (at least that of the unknowns) determine both sides.
  const int lattice = std::max({from, to, 1});
  const int rows = triangle_size(lattice), columns = triangle_size(to);
  Eigen::MatrixXd matrix(rows, columns);
  Eigen::VectorXd values(rows);
  std::vector<double> basis(at(columns));
  for (int r = 0; r < rows; ++r) {
    const Lambda lambda = lattice_point(lattice, r);
    const Vec2 p = bernstein::evaluate<Vec2>(g, control, lambda);
    bernstein::basis(to, frame.lambda(p), basis);
    for (int c = 0; c < columns; ++c) matrix(r, c) = basis[at(c)];
    values(r) = bernstein::evaluate<double>(from, std::span<const double>(b), lambda);
  }
  const Eigen::VectorXd solution = matrix.colPivHouseholderQr().solve(values);
  const double residual = (matrix * solution - values).cwiseAbs().maxCoeff();
  if (!(residual <= believable * scale)) return std::nullopt;
  return std::vector<double>(solution.data(), solution.data() + columns);
}

/// Coefficients of a continuous space's field: the first element that has a dof gives its value.
std::optional<std::vector<double>> share(const Space& space, const MappedField& field) {
  const auto width = at(field.components);
  const double tolerance = believable * largest(field.coefficients);
  std::vector<double> dofs(space.dof_count() * width);
  std::vector<bool> seen(space.dof_count(), false);
  const std::size_t elements = space.mesh()->element_count();
  std::size_t position = 0;
  for (std::size_t e = 0; e < elements; ++e)
    for (const std::int32_t dof : space.dofs(ElementId(e))) {
      const auto d = static_cast<std::size_t>(dof);
      for (std::size_t c = 0; c < width; ++c) {
        const double value = field.coefficients[position++];
        if (!seen[d]) {
          dofs[d * width + c] = value;
        } else if (!(std::abs(dofs[d * width + c] - value) <= tolerance)) {
          return std::nullopt;
        }
      }
      seen[d] = true;
    }
  return space.expand(dofs, field.components);
}

}  // namespace

int mapped_degree(const Field& field) {
  const int highest = field.space().highest_degree();
  if (field.space().basis() == Basis::reference) return highest;
  const int g = field.mesh().degree();
  if (highest * g > Space::max_degree)
    throw InputError(
        {{}, 0, "", -1},
        fmt::format("field '{}': degree {} in x and y on elements of degree {} is degree {} in "
                    "reference coordinates, this format holds at most {}; the native format (.bzl) "
                    "keeps it",
                    field.name(), highest, g, highest * g, Space::max_degree));
  return highest * g;
}

MappedField map_field(const Field& field, int degree) {
  const Space& space = field.space();
  const int components = field.components();
  const auto width = at(components);
  const std::size_t elements = field.mesh().element_count();
  const auto size = at(triangle_size(degree));
  MappedField out{field.name(), components, degree, {}};
  if (space.basis() == Basis::reference && space.uniform_degree() == degree) {
    out.coefficients.assign(field.coefficients().begin(), field.coefficients().end());
    return out;
  }
  out.coefficients.resize(elements * size * width);
  const int g = field.mesh().degree();
  parallel_for(elements, [&](std::size_t e) {
    const ElementId id(e);
    const int own = space.degree(id);
    double* const target = out.coefficients.data() + e * size * width;
    const auto put = [&](int c, int from, std::vector<double> b) {
      const std::vector<double> raised = raise_or_reduce(from, std::move(b), degree);
      for (std::size_t i = 0; i < size; ++i) target[i * width + at(c)] = raised[i];
    };
    if (space.basis() == Basis::reference || own == 0) {
      for (int c = 0; c < components; ++c)
        put(c, own, component(field.coefficients(id), c, components));
      return;
    }
    // f(b(lambda)) is a polynomial of degree own * g: its values on that lattice determine it.
    const int composed = own * g;
    const auto points = at(triangle_size(composed));
    std::vector<double> values(points * width);
    for (std::size_t n = 0; n < points; ++n)
      field.evaluate(id, lattice_point(composed, static_cast<int>(n)),
                     std::span<double>(values).subspan(n * width, width));
    for (int c = 0; c < components; ++c)
      put(c, composed,
          bernstein::from_lagrange<double>(composed, component(values, c, components)));
  });
  return out;
}

void say_raised(const Field& field, int degree, std::vector<std::string>& lost) {
  const Space& space = field.space();
  if (space.basis() == Basis::physical) {
    lost.push_back(fmt::format(
        "field '{}': degree {} in x and y, written as degree {} in reference coordinates; bezel "
        "restores it",
        field.name(), space.highest_degree(), degree));
  } else if (space.uniform_degree() < 0) {
    lost.push_back(
        fmt::format("field '{}': its degree varies from element to element, written as degree {} "
                    "everywhere; bezel restores it",
                    field.name(), degree));
  } else if (space.uniform_degree() != degree) {
    lost.push_back(fmt::format("field '{}': degree {}, written as degree {}; bezel restores it",
                               field.name(), space.uniform_degree(), degree));
  }
}

MappedField change_degree(const MappedField& field, int degree) {
  if (degree == field.degree) return field;
  MappedField out{field.name, field.components, degree, {}};
  const auto width = at(field.components);
  const auto from = at(triangle_size(field.degree)) * width;
  const auto to = at(triangle_size(degree)) * width;
  const std::size_t elements = field.coefficients.size() / from;
  out.coefficients.resize(elements * to);
  for (std::size_t e = 0; e < elements; ++e)
    for (int c = 0; c < field.components; ++c) {
      const std::vector<double> b = raise_or_reduce(
          field.degree,
          component(std::span<const double>(field.coefficients).subspan(e * from, from), c,
                    field.components),
          degree);
      for (std::size_t i = 0; i < b.size(); ++i)
        out.coefficients[e * to + i * width + at(c)] = b[i];
    }
  return out;
}

Field restore_field(const std::shared_ptr<const TriangleMesh>& mesh, MappedField field,
                    const FieldMetadata* metadata, bool continuous,
                    std::vector<std::string>& notes) {
  const std::size_t elements = mesh->element_count();
  const auto stale = [&](const char* what) {
    notes.push_back(
        fmt::format("field '{}': its metadata says {}, which its values are not; it "
                    "was read as degree {} in reference coordinates",
                    field.name, what, field.degree));
  };

  if (metadata && metadata->components < field.components) {  // padded for the format
    const auto width = at(field.components), kept = at(metadata->components);
    bool zero = true;
    for (std::size_t i = 0; i < field.coefficients.size(); ++i)
      zero = zero && (i % width < kept || field.coefficients[i] == 0.0);
    if (zero) {
      std::vector<double> fewer;
      fewer.reserve(field.coefficients.size() / width * kept);
      for (std::size_t i = 0; i < field.coefficients.size(); ++i)
        if (i % width < kept) fewer.push_back(field.coefficients[i]);
      field.coefficients = std::move(fewer);
      field.components = metadata->components;
    }
  }
  if (metadata && metadata->components != field.components) {
    stale(fmt::format("{} components", metadata->components).c_str());
    metadata = nullptr;
  }
  if (metadata && metadata->degrees.size() != 1 && metadata->degrees.size() != elements) {
    stale("a degree for another number of elements");
    metadata = nullptr;
  }

  const auto width = at(field.components);
  const auto size = at(triangle_size(field.degree));
  const auto element = [&](std::size_t e, int c) {
    return component(
        std::span<const double>(field.coefficients).subspan(e * size * width, size * width), c,
        field.components);
  };
  if (metadata) {
    std::vector<int> degrees = metadata->degrees;
    if (degrees.size() == 1) degrees.assign(elements, metadata->degrees[0]);
    const bool physical = metadata->basis == Basis::physical;
    const bool too_high = !physical && std::any_of(degrees.begin(), degrees.end(),
                                                   [&](int d) { return d > field.degree; });
    const bool plain = !physical && metadata->degrees.size() == 1 && degrees[0] == field.degree;
    if (too_high) {
      stale("a higher degree");
    } else if (!plain) {
      const double scale = largest(field.coefficients);
      const auto space =
          Space::discontinuous(mesh, degrees, physical ? Basis::physical : Basis::reference);
      std::vector<double> restored(space->coefficient_count() * width);
      std::vector<char> good(elements, 1);
      parallel_for(elements, [&](std::size_t e) {
        const ElementId id(e);
        const std::vector<Vec2> control = mesh->gather(id);
        for (int c = 0; c < field.components; ++c) {
          const std::vector<double> b = element(e, c);
          const auto found = physical ? fit_physical(control, mesh->degree(), field.degree, b,
                                                     space->frame(id), degrees[e], scale)
                                      : reduce_exactly(field.degree, b, degrees[e], scale);
          if (!found) {
            good[e] = 0;
            return;
          }
          for (std::size_t i = 0; i < found->size(); ++i)
            restored[(space->offset(id) + i) * width + at(c)] = (*found)[i];
        }
      });
      if (std::all_of(good.begin(), good.end(), [](char g) { return g != 0; })) {
        const bool finish = physical || metadata->degrees.size() != 1 ||
                            metadata->continuity == Continuity::discontinuous;
        if (finish) return Field(field.name, space, std::move(restored), field.components);
        field.degree = degrees[0];
        field.coefficients = std::move(restored);
      } else {
        stale(physical ? "a polynomial in x and y" : "a lower degree");
      }
    }
    continuous = metadata->continuity == Continuity::continuous;
  }

  if (continuous && field.degree >= 1) {
    std::shared_ptr<const Space> space;
    try {
      space = Space::continuous(mesh, field.degree);
    } catch (const InputError& error) {
      notes.push_back(
          fmt::format("field '{}' was read as discontinuous: {}", field.name, error.what()));
    }
    if (space) {
      if (auto coefficients = share(*space, field))
        return Field(field.name, space, std::move(*coefficients), field.components);
      notes.push_back(
          fmt::format("field '{}' was read as discontinuous: its values differ between neighbours",
                      field.name));
    }
  }
  return Field(field.name, Space::discontinuous(mesh, field.degree), std::move(field.coefficients),
               field.components);
}

std::vector<double> per_node(const TriangleMesh& mesh, std::span<const NodeId> connectivity,
                             std::size_t node_count, const MappedField& field) {
  const auto width = at(field.components);
  std::vector<double> values(node_count * width);
  std::vector<bool> seen(node_count, false);
  assume(at(triangle_size(field.degree)) * mesh.element_count() == connectivity.size(),
         "per_node: the field is not of the geometric degree");
  for (std::size_t i = 0; i < connectivity.size(); ++i) {
    const std::size_t n = connectivity[i].index();
    if (seen[n]) continue;
    seen[n] = true;
    for (std::size_t c = 0; c < width; ++c)
      values[n * width + c] = field.coefficients[i * width + c];
  }
  return values;
}

}  // namespace bezel::files
