#pragma once
// The drawing surface behind pictures and plots: a few primitives, drawn by an SVG and a PNG back
// end.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bezel/field/field.hpp"
#include "bezel/numeric/vec.hpp"
#include "bezel/view/colour.hpp"

namespace bezel::view {

/// Subpaths of Bezier pieces in pixels, x to the right and y downwards; pixel (i, j) covers [i,
/// i+1] x [j, j+1].
class Path {
 public:
  void move(const Vec2& p);
  void line(const Vec2& p);
  /// Appends a Bezier curve of degree 1..60 from the current point, which must equal control[0].
  void curve(std::span<const Vec2> control);
  void close();
  void rectangle(const Box2& box);
  /// A circle as four cubics, within 3e-4 of its radius.
  void circle(const Vec2& centre, double radius);

  enum class Verb { move, curve, close };
  struct Piece {
    Verb verb;
    std::size_t first;  ///< of points(): a move has one point, a curve 1 + degree with its start
    int degree;         ///< of a curve; 0 otherwise
  };
  std::span<const Piece> pieces() const { return pieces_; }
  std::span<const Vec2> points() const { return points_; }
  std::span<const Vec2> control(const Piece& piece) const;

 private:
  std::vector<Piece> pieces_;
  std::vector<Vec2> points_;
  Vec2 start_, current_;
};

struct Stroke {
  Colour colour;
  double width = 1.0;          ///< pixels; joins and ends are round
  std::vector<double> dash{};  ///< lengths of dashes and gaps in turn, pixels; empty: solid
};

enum class Anchor { start, middle, end };
struct TextStyle {
  double size = 14.0;  ///< of the em square, pixels
  Colour colour;
  Anchor anchor = Anchor::start;
  bool bold = false;
  bool upwards = false;       ///< turned by 90 degrees to run from bottom to top
  std::string superscript{};  ///< follows the text, smaller and raised
};

/// The map from the plane to pixels: the same scale both ways, y flipped.
struct Viewport {
  double scale = 1.0;
  Vec2 origin;  ///< pixel position of (0, 0)
  Vec2 operator()(const Vec2& p) const {
    return Vec2{{origin.x() + scale * p.x(), origin.y() - scale * p.y()}};
  }
  Vec2 inverse(const Vec2& q) const {
    return Vec2{{(q.x() - origin.x()) / scale, (origin.y() - q.y()) / scale}};
  }
};

/// A box of the plane fitted into the middle of a box of pixels.
Viewport fit(const Box2& plane, const Box2& pixels);

/// A scalar of a field as colours: t = (value - lo) / (hi - lo) through the map.
struct FieldPaint {
  const Field* field = nullptr;
  int component = 0;  ///< -1: Euclidean norm
  double lo = 0.0, hi = 1.0;
  const ColourMap* map = nullptr;
  Viewport viewport;
};

/// A picture under construction. Later primitives lie on top of earlier ones; the background is
/// white.
class Canvas {
 public:
  Canvas() = default;
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;
  virtual ~Canvas() = default;

  /// Fills closed subpaths; those that overlap should run in the same direction.
  virtual void fill(const Path& path, const Colour& colour) = 0;
  virtual void stroke(const Path& path, const Stroke& stroke) = 0;
  /// Text with its baseline at p. UTF-8; the PNG font has printable ASCII, the minus and the times
  /// sign.
  virtual void text(const Vec2& p, std::string_view text, const TextStyle& style) = 0;
  /// A box filled with the map, t = 0 at the bottom.
  virtual void gradient(const Box2& box, const ColourMap& map) = 0;
  virtual void field(const FieldPaint& paint) = 0;
  /// The finished file's bytes.
  virtual std::string finish() = 0;
};

std::unique_ptr<Canvas> make_svg_canvas(int width, int height);
std::unique_ptr<Canvas> make_png_canvas(int width, int height);
/// Back end by the extension of `path`.
/// @throws InputError when it is neither .svg nor .png (either case)
std::unique_ptr<Canvas> make_canvas(const std::string& path, int width, int height);
/// Throws the InputError of make_canvas without making one.
void check_extension(const std::string& path);

/// Superscripts: their size and height over the baseline, as parts of the text's size; bold text is
/// wider.
inline constexpr double superscript_size = 0.7, superscript_rise = 0.38, bold_stretch = 1.06;

/// Width of a line of text in pixels; both back ends lay text out with it (metrics of a
/// Helvetica-like sans serif).
double text_width(std::string_view text, const TextStyle& style);

/// Appends points of a Bezier curve after its start, whose chords stay within `tolerance` of it.
/// The reversed curve gives the same points reversed (up to rounding).
void flatten(std::span<const Vec2> control, double tolerance, std::vector<Vec2>& out);

}  // namespace bezel::view
