#include "bezel/formula/formula.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"

namespace bezel {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct ValueCase {
  const char* text;
  double expected;  // at x = 3, y = -2, exact unless noted
};

class FormulaValue : public testing::TestWithParam<ValueCase> {};

TEST_P(FormulaValue, IsExact) {
  const Formula f(GetParam().text);
  EXPECT_EQ(f(3, -2), GetParam().expected) << GetParam().text;
}

INSTANTIATE_TEST_SUITE_P(
    Arithmetic, FormulaValue,
    testing::Values(ValueCase{"1+2*3", 7}, ValueCase{"(1+2)*3", 9}, ValueCase{"10-4-3", 3},
                    ValueCase{"16/4/2", 2}, ValueCase{"2^3^2", 512}, ValueCase{"-x^2", -9},
                    ValueCase{"(-x)^2", 9}, ValueCase{"2^-1", 0.5}, ValueCase{"2^-x", 0.125},
                    ValueCase{"-2^-2", -0.25}, ValueCase{"x*-y", 6}, ValueCase{"x--y", 1},
                    ValueCase{"+-+x", -3}, ValueCase{"y^3", -8}, ValueCase{"y^0", 1},
                    ValueCase{"0^0", 1}, ValueCase{"y^-3", -0.125}, ValueCase{" 1 +\t2 ", 3},
                    ValueCase{".5", 0.5}, ValueCase{"1.", 1}, ValueCase{"1.5e2", 150},
                    ValueCase{"2E-1", 0.2}, ValueCase{"e", std::numbers::e},
                    ValueCase{"pi", std::numbers::pi}, ValueCase{"5*y^3+x^2+2*y+3", -32}));

INSTANTIATE_TEST_SUITE_P(
    Functions, FormulaValue,
    testing::Values(ValueCase{"sin(x)", std::sin(3.0)}, ValueCase{"cos(x)", std::cos(3.0)},
                    ValueCase{"tan(x)", std::tan(3.0)}, ValueCase{"asin(x/4)", std::asin(0.75)},
                    ValueCase{"acos(x/4)", std::acos(0.75)}, ValueCase{"atan(x)", std::atan(3.0)},
                    ValueCase{"atan2(y,x)", std::atan2(-2.0, 3.0)},
                    ValueCase{"sinh(x)", std::sinh(3.0)}, ValueCase{"cosh(x)", std::cosh(3.0)},
                    ValueCase{"tanh(x)", std::tanh(3.0)}, ValueCase{"exp(x)", std::exp(3.0)},
                    ValueCase{"log(x)", std::log(3.0)}, ValueCase{"log10(x)", std::log10(3.0)},
                    ValueCase{"log2(x+5)", 3}, ValueCase{"sqrt(x+1)", 2},
                    ValueCase{"cbrt(y*4)", -2}, ValueCase{"abs(y)", 2}, ValueCase{"sign(y)", -1},
                    ValueCase{"sign(0)", 0}, ValueCase{"floor(y/4)", -1}, ValueCase{"ceil(x/2)", 2},
                    ValueCase{"min(x,y)", -2}, ValueCase{"max(x,y)", 3},
                    ValueCase{"min(x,1,y,7)", -2}, ValueCase{"max(x,1,y,7)", 7},
                    ValueCase{"pow(x,2)", 9}, ValueCase{"pow(x,y)", 1.0 / 9},
                    ValueCase{"hypot(x,y*2)", 5}, ValueCase{"step(y)", 0}, ValueCase{"step(0)", 1},
                    ValueCase{"step(x)", 1}, ValueCase{"if(x>y,x,y)", 3},
                    ValueCase{"if(x<y,x,y)", -2}, ValueCase{"if(x>0,log(x),0)", std::log(3.0)}));

INSTANTIATE_TEST_SUITE_P(Logic, FormulaValue,
                         testing::Values(ValueCase{"x<3", 0}, ValueCase{"x<=3", 1},
                                         ValueCase{"x>3", 0}, ValueCase{"x>=3", 1},
                                         ValueCase{"x==3", 1}, ValueCase{"x!=3", 0},
                                         ValueCase{"x>0 && y>0", 0}, ValueCase{"x>0 || y>0", 1},
                                         ValueCase{"1 || 0 && 0", 1},
                                         ValueCase{"x+1 > y*2 && 1", 1}));

TEST(Formula, KeepsItsTextAndVariables) {
  const Formula f("a+b*b", {"a", "b"});
  EXPECT_EQ(f.text(), "a+b*b");
  EXPECT_EQ(f.variables(), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(f(1, 3), 10);
}

TEST(Formula, AnyNumberOfVariables) {
  const Formula constant("2*3", {});
  EXPECT_EQ(constant(std::span<const double>{}), 6);
  const Formula f("x+10*y+100*z+1000*t_1", {"x", "y", "z", "t_1"});
  EXPECT_EQ(f(std::array{1.0, 2.0, 3.0, 4.0}), 4321);
}

TEST(Formula, AVariableHidesAConstant) {
  EXPECT_EQ(Formula("e+pi", {"e", "pi"})(1, 2), 3);
  EXPECT_EQ(Formula("sin+1", {"sin", "y"})(1, 2), 2);
}

TEST(Formula, CopiesAndMovedFromFormulasWork) {
  Formula f("x+y");
  const Formula copy = f;
  Formula moved = std::move(f);
  EXPECT_EQ(copy(1, 2), 3);
  EXPECT_EQ(moved(1, 2), 3);
  moved = Formula("x*y");
  EXPECT_EQ(moved(3, 2), 6);
}

TEST(Formula, IntegerPowersAreExactOnIntegers) {
  // 3^33 < 2^53: every product on the way is exact.
  for (int n = 0; n <= 33; ++n) {
    double expected = 1;
    for (int k = 0; k < n; ++k) expected *= 3;
    const std::string text = std::string("x^").append(std::to_string(n));
    EXPECT_EQ(Formula(text)(3, 0), expected) << text;
    EXPECT_EQ(Formula(text)(-3, 0), n % 2 == 0 ? expected : -expected) << text;
    EXPECT_EQ(Formula(std::string("x^-").append(std::to_string(n)))(3, 0), 1 / expected) << text;
  }
  EXPECT_EQ(Formula("x^64")(2, 0), 0x1p64);
  EXPECT_EQ(Formula("x^100")(2, 0), 0x1p100);
  EXPECT_EQ(Formula("x^101")(-2, 0), -0x1p101);
}

TEST(Formula, OutsideTheDomainTheValueSaysSo) {
  EXPECT_TRUE(std::isnan(Formula("sqrt(x)")(-1, 0)));
  EXPECT_TRUE(std::isnan(Formula("log(x)")(-1, 0)));
  EXPECT_EQ(Formula("1/x")(0, 0), infinity);
  EXPECT_EQ(Formula("log(x)")(0, 0), -infinity);
}

TEST(Formula, NotANumberStays) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const char* text : {"min(x,y)", "min(y,x)", "max(x,y)", "max(y,x)", "step(x)", "sign(x)",
                           "abs(x)", "x^2", "floor(x)"}) {
    EXPECT_TRUE(std::isnan(Formula(text)(nan, 1))) << text;
  }
  EXPECT_EQ(Formula("x==x")(nan, 0), 0);
  EXPECT_EQ(Formula("x!=x")(nan, 0), 1);
}

// ---- errors ----

struct ErrorCase {
  std::string text, message;
};

std::string parse_error(const std::string& text, std::vector<std::string> variables = {"x", "y"}) {
  try {
    const Formula f(text, std::move(variables));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FormulaError, NamesTheColumnAndWhatWasExpected) {
  const std::vector<ErrorCase> cases{
      {"x + 2*z", "column 7: unknown name 'z', expected one of x, y, a function or a number"},
      {"", "column 1: expected a value, found the end"},
      {"   ", "column 4: expected a value, found the end"},
      {"x +", "column 4: expected a value, found the end"},
      {"x + * y", "column 5: expected a value, found '*'"},
      {"2x", "column 2: expected an operator or the end, found 'x'"},
      {"x y", "column 3: expected an operator or the end, found 'y'"},
      {"(x", "column 3: expected ')', found the end"},
      {"x)", "column 2: expected an operator or the end, found ')'"},
      {"sin x", "column 5: expected '(' after sin, found 'x'"},
      {"sin(x", "column 6: expected ')' or ',', found the end"},
      {"sin(x y)", "column 7: expected ')' or ',', found 'y'"},
      {"1+sin(x,y)", "column 3: sin takes 1 argument, found 2"},
      {"atan2(x)", "column 1: atan2 takes 2 arguments, found 1"},
      {"sin()", "column 1: sin takes 1 argument, found 0"},
      {"if(x,y)", "column 1: if takes 3 arguments, found 2"},
      {"min(x)", "column 1: min takes at least 2 arguments, found 1"},
      {"1+foo(x)",
       "column 3: unknown function 'foo', expected one of sin, cos, tan, asin, acos, atan, atan2, "
       "sinh, cosh, tanh, exp, log, log10, log2, sqrt, cbrt, abs, sign, floor, ceil, min, max, "
       "pow, hypot, step, if"},
      {"x(y)", "column 2: 'x' is not a function; expected an operator, found '('"},
      {"0<x<1", "column 4: comparisons cannot be chained, use && between them"},
      {"x = 1", "column 3: expected an operator or the end, found '='"},
      {"x & y", "column 3: expected an operator or the end, found '&'"},
      {"1e400", "column 1: number 1e400 is outside the range of a double"},
      {"x*1e-400", "column 3: number 1e-400 is outside the range of a double"},
      {"1..2", "column 3: expected an operator or the end, found '.'"},
      {".", "column 1: expected a number, found '.'"},
      {"x\x01", "column 2: expected an operator or the end, found byte 0x01"},
      {"x\xc2\xb2", "column 2: expected an operator or the end, found byte 0xc2"},
      {std::string("x\0", 2), "column 2: expected an operator or the end, found byte 0x00"},
  };
  for (const ErrorCase& c : cases) EXPECT_EQ(parse_error(c.text), c.message) << c.text;
}

TEST(FormulaError, Variables) {
  EXPECT_EQ(parse_error("1", {"x", "x"}), "variable 'x' is named twice");
  EXPECT_EQ(parse_error("1", {"1x"}), "variable '1x' is not a name of letters, digits and _");
  EXPECT_EQ(parse_error("1", {""}), "variable '' is not a name of letters, digits and _");
  EXPECT_EQ(parse_error("1", std::vector<std::string>(65, "x")),
            "formula of 65 variables, at most 64 are allowed");
  EXPECT_EQ(parse_error("z", {}), "column 1: unknown name 'z', expected a function or a number");
}

TEST(FormulaError, SizesAreChecked) {
  const Formula f("x+y+z", {"x", "y", "z"});
  std::array<double, 2> two{};
  std::array<double, 3> three{};
  const auto message = [](auto&& action) {
    try {
      action();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(message([&] { f(1, 2); }), "formula of 3 variables, found 2 values");
  EXPECT_EQ(message([&] { f.gradient(two, three); }), "formula of 3 variables, found 2 values");
  EXPECT_EQ(message([&] { f.gradient(three, two); }),
            "formula of 3 variables, found 2 first derivatives");
  EXPECT_EQ(message([&] { f.hessian(three, three, three); }),
            "formula of 3 variables, found room for 3 second derivatives instead of 9");
  const std::vector<std::span<const double>> columns{three, three, two};
  EXPECT_EQ(message([&] { f.evaluate(columns, three); }),
            "formula evaluated at 3 points, found a column of 2");
  EXPECT_EQ(message([&] { f.evaluate({}, three); }), "formula of 3 variables, found 0 columns");
}

TEST(FormulaError, DeepNestingAndLengthAreRefusedWithoutOverflow) {
  const auto repeat = [](const std::string& s, std::size_t n) {
    std::string text;
    for (std::size_t i = 0; i < n; ++i) text += s;
    return text;
  };
  EXPECT_EQ(parse_error(repeat("(", 1'000'000)),
            "formula of 1000000 characters, at most 65536 are allowed");
  for (const char* s : {"(", "-", "sin(", "2^", "x^-", "1+(", "if(1,2,"}) {
    const std::string text = repeat(s, 65536 / std::strlen(s));
    const std::string message = parse_error(text);
    EXPECT_NE(message.find(": nested deeper than 200 levels"), std::string::npos) << message;
  }
  EXPECT_EQ(Formula(repeat("(", 199).append("x").append(repeat(")", 199)))(5, 0), 5);
  EXPECT_EQ(parse_error(repeat("(", 200).append("x").append(repeat(")", 200))),
            "column 201: nested deeper than 200 levels");
  // Long but flat, and a deep stack of pending operands: both work.
  EXPECT_EQ(Formula(repeat("x+", 20000).append("x"))(1, 0), 20001);
  std::string deep = repeat("1||x>0&&x+1<x*2*(", 190);
  deep.append("x").append(repeat(")", 190));
  EXPECT_EQ(Formula(deep)(5, 0), 1);
}

TEST(FormulaError, RandomBytesNeverDoWorse) {
  // Anything is either a formula or an InputError with a column inside the text (or one past it).
  const std::vector<std::string> pieces{
      "x",  "y", "(", ")", "+",  "-",  "*",   "/",    "^",   ",",      "<",  ">=",  "==", "!=",
      "&&", "|", "1", ".", "e5", "pi", "sin", "min(", "if(", "atan2(", "\n", "1e9", "z",  "\xff"};
  RandomStream random("FormulaError.RandomBytesNeverDoWorse", 1);
  int good = 0;
  for (int round = 0; round < 40000; ++round) {
    std::string text;
    const bool bytes = round % 4 == 0;
    for (std::uint64_t n = random.below(bytes ? 12 : 9); n-- > 0;) {
      if (bytes) {
        text += static_cast<char>(random.below(256));
      } else {
        text += pieces[random.below(pieces.size())];
      }
    }
    try {
      const Formula f(text);
      static_cast<void>(f(0.5, 0.25));
      ++good;
    } catch (const InputError& error) {
      const std::string what = error.what();
      ASSERT_EQ(what.rfind("column ", 0), 0u) << what;
      const int column = std::stoi(what.substr(7));
      ASSERT_GE(column, 1);
      ASSERT_LE(column, static_cast<int>(text.size()) + 1) << text << ": " << what;
    }
  }
  EXPECT_GT(good, 400);  // both outcomes are really seen
}

// ---- many points ----

const std::vector<std::string>& many_formulas() {
  static const std::vector<std::string> list{"1",
                                             "x",
                                             "5*y^3+x^2+2*y+3",
                                             "exp(x^2)+2*y",
                                             "sin(x)+cos(y)",
                                             "x^2.5",
                                             "abs(x)^y",
                                             "tan(x)*atan(y)-atan2(y,x)",
                                             "asin(x/4)+acos(y/4)",
                                             "sinh(x)-cosh(y)*tanh(x)",
                                             "log(x+4)+log10(y+4)+log2(x+5)",
                                             "sqrt(x+4)+cbrt(y)",
                                             "sign(x)+floor(y)+ceil(x)+step(y)",
                                             "min(x,y,0.1)+max(x,y)+hypot(x,y)",
                                             "if(x<y && x>-1 || y==2, x/y, y-x)",
                                             "(x<=y)+(x>=y)+(x!=y)+(x==y)",
                                             "-x^-3+pow(y,4)"};
  return list;
}

TEST(FormulaMany, SameBitsAsOneByOne) {
  RandomStream random("FormulaMany.SameBitsAsOneByOne", 1);
  for (const std::size_t n : {0u, 1u, 255u, 256u, 257u, 1000u}) {
    std::vector<double> x(n), y(n), out(n);
    for (std::size_t q = 0; q < n; ++q) {
      x[q] = random.uniform(-3, 3);
      y[q] = random.uniform(-3, 3);
    }
    for (const std::string& text : many_formulas()) {
      const Formula f(text);
      const std::vector<std::span<const double>> columns{x, y};
      f.evaluate(columns, out);
      for (std::size_t q = 0; q < n; ++q) {
        const double one = f(x[q], y[q]);
        ASSERT_TRUE(out[q] == one || (std::isnan(out[q]) && std::isnan(one)))
            << text << " at " << x[q] << ", " << y[q];
      }
    }
  }
}

TEST(FormulaMany, TheResultMayReplaceAColumn) {
  std::vector<double> x(600, 2.0), y(600, 3.0);
  const std::vector<std::span<const double>> columns{x, y};
  Formula("x*y+x").evaluate(columns, x);
  EXPECT_EQ(x, std::vector<double>(600, 8.0));
}

// ---- derivatives ----

struct DerivativeCase {
  const char *f, *fx, *fy, *fxx, *fxy, *fyy;
};

class FormulaDerivative : public testing::TestWithParam<DerivativeCase> {};

// Within 60 u of the sum of magnitudes, where one operation costs u or 2 u and the cases have up to
// 20 of them.
void expect_close(double found, double expected, const char* what) {
  EXPECT_NEAR(found, expected, 60 * 0x1p-53 * std::max(1.0, std::fabs(expected))) << what;
}

TEST_P(FormulaDerivative, MatchesTheOneByHand) {
  const DerivativeCase& c = GetParam();
  const Formula f(c.f);
  RandomStream random(c.f, 1);
  for (int round = 0; round < 50; ++round) {
    const std::array<double, 2> p{random.uniform(0.1, 0.9), random.uniform(0.1, 0.9)};
    std::array<double, 2> g{}, g2{};
    std::array<double, 4> h{};
    EXPECT_EQ(f.gradient(p, g), f(p));
    EXPECT_EQ(f.hessian(p, g2, h), f(p));
    EXPECT_EQ(g, g2);
    EXPECT_EQ(h[1], h[2]);
    expect_close(g[0], Formula(c.fx)(p), c.fx);
    expect_close(g[1], Formula(c.fy)(p), c.fy);
    expect_close(h[0], Formula(c.fxx)(p), c.fxx);
    expect_close(h[1], Formula(c.fxy)(p), c.fxy);
    expect_close(h[3], Formula(c.fyy)(p), c.fyy);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, FormulaDerivative,
    testing::Values(
        DerivativeCase{"3", "0", "0", "0", "0", "0"},
        DerivativeCase{"x*y+2*x-y", "y+2", "x-1", "0", "1", "0"},
        DerivativeCase{"5*y^3+x^2+2*y+3", "2*x", "15*y^2+2", "2", "0", "30*y"},
        DerivativeCase{"exp(x^2)+2*y", "2*x*exp(x^2)", "2", "(2+4*x^2)*exp(x^2)", "0", "0"},
        DerivativeCase{"sin(x)*cos(y)", "cos(x)*cos(y)", "-sin(x)*sin(y)", "-sin(x)*cos(y)",
                       "-cos(x)*sin(y)", "-sin(x)*cos(y)"},
        DerivativeCase{"x/y", "1/y", "-x/y^2", "0", "-1/y^2", "2*x/y^3"},
        DerivativeCase{"tan(x)", "1/cos(x)^2", "0", "2*tan(x)/cos(x)^2", "0", "0"},
        DerivativeCase{"asin(x)", "1/sqrt(1-x^2)", "0", "x/(1-x^2)^1.5", "0", "0"},
        DerivativeCase{"acos(x)", "-1/sqrt(1-x^2)", "0", "-x/(1-x^2)^1.5", "0", "0"},
        DerivativeCase{"atan(x)", "1/(1+x^2)", "0", "-2*x/(1+x^2)^2", "0", "0"},
        DerivativeCase{"sinh(x)+cosh(y)", "cosh(x)", "sinh(y)", "sinh(x)", "0", "cosh(y)"},
        DerivativeCase{"tanh(x)", "1/cosh(x)^2", "0", "-2*tanh(x)/cosh(x)^2", "0", "0"},
        DerivativeCase{"log(x)+log10(y)", "1/x", "1/(y*log(10))", "-1/x^2", "0",
                       "-1/(y^2*log(10))"},
        DerivativeCase{"log2(x)", "1/(x*log(2))", "0", "-1/(x^2*log(2))", "0", "0"},
        DerivativeCase{"sqrt(x)", "0.5/sqrt(x)", "0", "-0.25/x^1.5", "0", "0"},
        DerivativeCase{"cbrt(x)", "1/(3*cbrt(x)^2)", "0", "-2/(9*cbrt(x)^5)", "0", "0"},
        DerivativeCase{"atan2(y,x)", "-y/(x^2+y^2)", "x/(x^2+y^2)", "2*x*y/(x^2+y^2)^2",
                       "(y^2-x^2)/(x^2+y^2)^2", "-2*x*y/(x^2+y^2)^2"},
        DerivativeCase{"hypot(x,y)", "x/hypot(x,y)", "y/hypot(x,y)", "y^2/hypot(x,y)^3",
                       "-x*y/hypot(x,y)^3", "x^2/hypot(x,y)^3"},
        DerivativeCase{"x^y", "y*x^(y-1)", "x^y*log(x)", "y*(y-1)*x^(y-2)", "x^(y-1)*(1+y*log(x))",
                       "x^y*log(x)^2"},
        DerivativeCase{"x^2.5", "2.5*x^1.5", "0", "3.75*x^0.5", "0", "0"},
        DerivativeCase{"x^-2", "-2*x^-3", "0", "6*x^-4", "0", "0"},
        DerivativeCase{"abs(x-2)*y", "-y", "2-x", "0", "-1", "0"},
        DerivativeCase{"min(x,2)*max(y,-3)", "y", "x", "0", "1", "0"},
        DerivativeCase{"floor(x)+ceil(y)+sign(x)+step(y)+(x<y)", "0", "0", "0", "0", "0"},
        DerivativeCase{"if(x>0.5,x^2,y^3)", "if(x>0.5,2*x,0)", "if(x>0.5,0,3*y^2)", "if(x>0.5,2,0)",
                       "0", "if(x>0.5,0,6*y)"}));

TEST(FormulaDerivatives, PowersAtZeroAndNegativeBases) {
  std::array<double, 2> g{};
  std::array<double, 4> h{};
  const std::array<double, 2> origin{0, 0}, left{-2, 3};
  Formula("x^0+x^1+x^2+x^3").hessian(origin, g, h);
  EXPECT_EQ(g[0], 1);
  EXPECT_EQ(h[0], 2);
  Formula("x^y").hessian(left, g, h);
  EXPECT_EQ(g[0], 12);            // y x^(y-1), also for a negative base
  EXPECT_TRUE(std::isnan(g[1]));  // log of a negative number
  Formula("pow(x, 3.0)+x^70").gradient(left, g);
  EXPECT_EQ(g[0], 12 + 70 * std::pow(-2.0, 69));
  Formula("x^2.5").hessian(origin, g, h);
  EXPECT_EQ(g[0], 0);
  EXPECT_EQ(h[0], 0);
}

TEST(FormulaDerivatives, ADirectionThatIsAbsentStaysZeroAtASingularity) {
  std::array<double, 2> g{};
  const std::array<double, 2> origin{0, 0};
  Formula("sqrt(y)+x").gradient(origin, g);
  EXPECT_EQ(g[0], 1);
  EXPECT_EQ(g[1], infinity);
  Formula("if(y>0, log(y), 0)+abs(x)").gradient(origin, g);
  EXPECT_EQ(g[0], 0);
  EXPECT_EQ(g[1], 0);
}

TEST(FormulaDerivatives, NoVariablesAndMany) {
  EXPECT_EQ(Formula("2*3", {}).gradient({}, {}), 6);
  EXPECT_EQ(Formula("2*3", {}).hessian({}, {}, {}), 6);
  const Formula f("a*b*c*d*k", {"a", "b", "c", "d", "k"});
  std::array<double, 5> g{};
  std::array<double, 25> h{};
  EXPECT_EQ(f.hessian(std::array{1.0, 2.0, 3.0, 4.0, 5.0}, g, h), 120);
  EXPECT_EQ(g, (std::array{120.0, 60.0, 40.0, 30.0, 24.0}));
  EXPECT_EQ(h[1 * 5 + 4], 12);
}

TEST(FormulaDerivatives, ThreeVariables) {
  const Formula f("x*y*z+z^2", {"x", "y", "z"});
  std::array<double, 3> g{};
  std::array<double, 9> h{};
  EXPECT_EQ(f.hessian(std::array{2.0, 3.0, 5.0}, g, h), 55);
  EXPECT_EQ(g, (std::array{15.0, 10.0, 16.0}));
  EXPECT_EQ(h, (std::array{0.0, 5.0, 3.0, 5.0, 0.0, 2.0, 3.0, 2.0, 2.0}));
}

}  // namespace
}  // namespace bezel
