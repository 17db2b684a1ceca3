#include "bezel/formula/formula.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/formula/operations.hpp"

namespace bezel {

using formula::Dual;
using formula::Instruction;
using formula::Op;

struct Formula::Program {
  std::string text;
  std::vector<std::string> variables;
  formula::Code code;

  void check(std::size_t found, const char* what) const {
    if (found == variables.size()) return;
    throw InputError("formula of " + std::to_string(variables.size()) + " variables, found " +
                     std::to_string(found) + " " + what);
  }

  template <class S>
  S run(const S* values) const {
    // Room for usual formulas without an allocation.
    constexpr int small = 12;
    if (code.stack_size <= small) {
      std::array<S, small> stack;
      return formula::run(code.instructions, values, stack.data());
    }
    std::vector<S> stack(static_cast<std::size_t>(code.stack_size));
    return formula::run(code.instructions, values, stack.data());
  }
};

Formula::Formula(std::string_view text, std::vector<std::string> variables) {
  auto program = std::make_shared<Program>();
  program->code = formula::compile(text, variables);
  program->text = text;
  program->variables = std::move(variables);
  program_ = std::move(program);
}
Formula::Formula(const Formula&) = default;
// A moved-from formula stays usable: copying the pointer costs next to nothing.
Formula::Formula(Formula&& other) noexcept : program_(other.program_) {}
Formula& Formula::operator=(const Formula&) = default;
Formula& Formula::operator=(Formula&& other) noexcept {
  program_ = other.program_;
  return *this;
}
Formula::~Formula() = default;

const std::string& Formula::text() const {
  return program_->text;
}
const std::vector<std::string>& Formula::variables() const {
  return program_->variables;
}

double Formula::operator()(std::span<const double> values) const {
  program_->check(values.size(), "values");
  return program_->run(values.data());
}

double Formula::operator()(double x, double y) const {
  const std::array<double, 2> values{x, y};
  return (*this)(values);
}

namespace {

constexpr std::size_t block =
    256;  // points at a time: a stack of ten blocks stays in the first-level cache

// The program for `n` <= block points from point `first`; stack holds stack_size blocks.
void run_block(const std::vector<Instruction>& instructions,
               std::span<const std::span<const double>> columns, std::size_t first, std::size_t n,
               double* stack, double* out) {
  double* end = stack;  // one block past the top
  for (const Instruction& i : instructions) {
    if (i.op == Op::constant) {
      std::fill_n(end, n, i.value);
      end += block;
    } else if (i.op == Op::variable) {
      std::copy_n(columns[static_cast<std::size_t>(i.index)].data() + first, n, end);
      end += block;
    } else if (formula::is_unary(i.op)) {
      double* a = end - block;
      formula::visit_unary<double>(i, [=](auto f) {
        for (std::size_t k = 0; k < n; ++k) a[k] = f(a[k]);
      });
    } else if (formula::is_binary(i.op)) {
      end -= block;
      double* a = end - block;
      const double* b = end;
      formula::visit_binary<double>(i.op, [=](auto f) {
        for (std::size_t k = 0; k < n; ++k) a[k] = f(a[k], b[k]);
      });
    } else {
      end -= 2 * block;
      double* c = end - block;
      for (std::size_t k = 0; k < n; ++k) c[k] = c[k] != 0 ? end[k] : end[block + k];
    }
  }
  std::copy_n(end - block, n, out);
}

}  // namespace

void Formula::evaluate(std::span<const std::span<const double>> columns,
                       std::span<double> out) const {
  program_->check(columns.size(), "columns");
  for (const auto& column : columns) {
    if (column.size() != out.size()) {
      throw InputError("formula evaluated at " + std::to_string(out.size()) +
                       " points, found a column of " + std::to_string(column.size()));
    }
  }
  const formula::Code& code = program_->code;
  std::vector<double> stack(static_cast<std::size_t>(code.stack_size) * block);
  for (std::size_t first = 0; first < out.size(); first += block) {
    const std::size_t n = std::min(block, out.size() - first);
    run_block(code.instructions, columns, first, n, stack.data(), out.data() + first);
  }
}

namespace {

// The point as dual numbers; a few variables need no allocation.
template <class S>
class DualPoint {
 public:
  explicit DualPoint(std::span<const double> values) {
    if (values.size() > few_.size()) many_.resize(values.size());
    data_ = many_.empty() ? few_.data() : many_.data();
    std::copy(values.begin(), values.end(), data_);
  }
  DualPoint(const DualPoint&) = delete;
  DualPoint& operator=(const DualPoint&) = delete;
  S& operator[](std::size_t i) { return data_[i]; }
  const S* data() const { return data_; }

 private:
  std::array<S, 4> few_{};
  std::vector<S> many_;
  S* data_;
};

}  // namespace

double Formula::gradient(std::span<const double> values, std::span<double> first) const {
  program_->check(values.size(), "values");
  program_->check(first.size(), "first derivatives");
  if (values.empty()) return (*this)(values);
  DualPoint<Dual<double>> point(values);
  Dual<double> f;
  for (std::size_t i = 0; i < values.size(); ++i) {
    point[i].d = 1;
    f = program_->run(point.data());
    first[i] = f.d;
    point[i].d = 0;
  }
  return f.v;  // the same operations as without derivatives
}

double Formula::hessian(std::span<const double> values, std::span<double> first,
                        std::span<double> second) const {
  const std::size_t n = program_->variables.size();
  program_->check(values.size(), "values");
  program_->check(first.size(), "first derivatives");
  if (second.size() != n * n) {
    throw InputError("formula of " + std::to_string(n) + " variables, found room for " +
                     std::to_string(second.size()) + " second derivatives instead of " +
                     std::to_string(n * n));
  }
  if (n == 0) return (*this)(values);
  using Second = Dual<Dual<double>>;
  DualPoint<Second> point(values);
  Second f;
  for (std::size_t i = 0; i < n; ++i) {
    point[i].d.v = 1;
    for (std::size_t j = i; j < n; ++j) {
      point[j].v.d = 1;
      f = program_->run(point.data());
      if (j == i) first[i] = f.d.v;
      second[i * n + j] = second[j * n + i] = f.d.d;
      point[j].v.d = 0;
    }
    point[i].d.v = 0;
  }
  return f.v.v;
}

}  // namespace bezel
