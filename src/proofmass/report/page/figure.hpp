#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Plots as SVG text. Colours are CSS variables of the enclosing page, so that one file suits dark
// and light screens and paper.
namespace proofmass::report {

/// Instead of a value: breaks a curve.
inline constexpr double gap = std::numeric_limits<double>::quiet_NaN();
/// Half width of a 95 % band, in standard deviations of a normal distribution.
inline constexpr double normal_95 = 1.96;

enum class AxisScale {
  linear,
  log,
  bare,  ///< linear, without ticks or axis line: for a map
};

struct Axis {
  std::string label;  ///< including its unit: "Time (s)"
  AxisScale scale = AxisScale::linear;
  std::optional<double> min = {}, max = {};  ///< limits of the axis; from the data if absent
};

/// Colours that remain distinguishable for colour-blind readers and in grey print.
/// Source: M. Okabe & K. Ito, Color Universal Design (2008), tuned for contrast on either ground.
enum class Ink { blue, orange, green, purple, red, grey };
/// "blue", …: name of the colour in style sheets and documents.
[[nodiscard]] std::string_view name_of(Ink ink);

enum class Mark {
  line,
  dashes,
  thin,    ///< a hairline, for the original data of a curve
  points,  ///< a dot at each value, for few values
  ticks,   ///< a short stroke at the bottom of the plot at each x: events
};

/// One curve. A value that is not finite (or, on a log axis, not positive) interrupts the line.
struct Curve {
  std::string label;  ///< in the legend; empty: omitted there
  std::vector<double> x, y;
  Ink ink = Ink::blue;
  Mark mark = Mark::line;
};

/// The area between two curves with the same x.
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

/// A labelled dot; omitted outside the plot.
struct Callout {
  std::string text;
  double x = 0.0, y = 0.0;
  Ink ink = Ink::grey;
  bool below = false;  ///< label below the dot instead of above
  bool left = false;   ///< label left of the dot instead of right, if there is room
  bool bare = false;   ///< label only, centred, without a dot
};

struct Figure {
  std::string title;
  std::string description;  ///< content in a sentence or two; also read by screen readers
  Axis x, y;
  std::vector<Band> bands = {};
  std::vector<Curve> curves = {};
  std::vector<Level> levels = {};
  std::vector<Callout> callouts = {};
  double height = 300.0;  ///< height of the plot's box, in units of which the width has 900
};

/// The figure as one <svg> element. `id` must be unique within the page: [a-z0-9-].
/// Cost: linear in the number of values; the length of the text is bounded by thinning
/// (page/thinning.hpp).
[[nodiscard]] std::string svg(const Figure& figure, const std::string& id);

/// Style of all figures, included once in a page; defines the colours, too.
[[nodiscard]] std::string figure_css();

}  // namespace proofmass::report
