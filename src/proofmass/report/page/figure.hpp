#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Plots as SVG text, drawn in the colours of the page around them (CSS variables), so that one file
// reads well on a dark screen, on a light one and on paper.
namespace proofmass::report {

/// In the place of a point: breaks a curve.
inline constexpr double gap = std::numeric_limits<double>::quiet_NaN();
/// Half of a 95 % band, in standard deviations of a normal distribution.
inline constexpr double normal_95 = 1.96;

enum class AxisScale {
  linear,
  log,
  bare,  ///< linear, without ticks and line: a map
};

struct Axis {
  std::string label;  ///< with its unit: "Time (s)"
  AxisScale scale = AxisScale::linear;
  std::optional<double> min = {}, max = {};  ///< ends of the axis; from the data where absent
};

/// Colours that stay apart for colour-blind eyes and in grey print.
/// Source: M. Okabe & K. Ito, Color Universal Design (2008), tuned for contrast on either ground.
enum class Ink { blue, orange, green, purple, red, grey };
/// "blue", …: of the colour in style sheets and documents.
[[nodiscard]] std::string_view name_of(Ink ink);

enum class Mark {
  line,
  dashes,
  thin,    ///< a hairline: what a curve is made of
  points,  ///< a dot at each value, for few values
  ticks,   ///< a short stroke at the foot of the plot at each x: events
};

/// One curve. A value that is not finite (or, on a log axis, not positive) breaks the line.
struct Curve {
  std::string label;  ///< in the legend; empty: not listed
  std::vector<double> x, y;
  Ink ink = Ink::blue;
  Mark mark = Mark::line;
};

/// The area between two curves over the same x.
struct Band {
  std::string label;
  std::vector<double> x, lower, upper;
  Ink ink = Ink::blue;
};

/// A straight line across the plot at one y.
struct Level {
  std::string label;  ///< written at the line itself
  double y = 0.0;
};

/// A dot on the plot with a word beside it; what lies outside the plot is left away.
struct Callout {
  std::string text;
  double x = 0.0, y = 0.0;
  Ink ink = Ink::grey;
  bool below = false;  ///< the word stands under its dot, not above
  bool left = false;   ///< and before it, not behind, if there is room
  bool bare = false;   ///< the word alone, in the middle of its place, without a dot
};

struct Figure {
  std::string title;
  std::string description;  ///< what it shows, in a sentence or two: for readers, seeing or not
  Axis x, y;
  std::vector<Band> bands = {};
  std::vector<Curve> curves = {};
  std::vector<Level> levels = {};
  std::vector<Callout> callouts = {};
  double height = 300.0;  ///< of the plot's box, in units of which the width has 900
};

/// The figure as one <svg> element. `id` must be unique within the page: [a-z0-9-].
/// Cost: linear in the values; the text is bounded, since long curves are thinned
/// (page/thinning.hpp).
[[nodiscard]] std::string svg(const Figure& figure, const std::string& id);

/// Style of all figures, which a page states once; also defines the colours themselves.
[[nodiscard]] std::string figure_css();

}  // namespace proofmass::report
