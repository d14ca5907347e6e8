#include "proofmass/report/page/figure.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <set>
#include <string_view>

#include "proofmass/core/contract.hpp"
#include "proofmass/report/page/thinning.hpp"
#include "proofmass/report/page/ticks.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

// The box of a figure in user units; the page scales it to its width.
constexpr double width = 900.0, left = 66.0, right = 26.0, foot = 48.0, row = 20.0;
constexpr double swatch = 24.0, letter = 6.9;  // advance of the 12.5-unit type, on average

// Maps the values of an axis to coordinates of the figure.
struct Mapping {
  double low, high;
  bool log;
  double from = 0.0, to = 0.0;

  [[nodiscard]] bool shows(double value) const {
    return std::isfinite(value) && (!log || value > 0.0);
  }
  [[nodiscard]] bool holds(double value) const {
    return shows(value) && value >= low && value <= high;
  }
  [[nodiscard]] double operator()(double value) const {
    const double part =
        log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    // Bounded, because some renderers fail on very large coordinates.
    return from + std::clamp(part, -20.0, 20.0) * (to - from);
  }
};

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void add(double value, bool log) {
    if (!std::isfinite(value) || (log && value <= 0.0)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void add(const std::vector<double>& values, bool log) {
    for (const double value : values) add(value, log);
  }
};

// Gives a range of zero width some extent.
void widen(double& low, double& high, bool log) {
  const double room = std::max(std::abs(low) * 1e-3, 1e-9);
  low = log ? low / 2.0 : low - room;
  high = log ? high * 2.0 : high + room;
}

// `margin`: part of the range added at each end that is not prescribed.
Mapping mapping(const Axis& axis, const Extent& data, double margin) {
  const bool log = axis.scale == AxisScale::log;
  double low = axis.min.value_or(data.low), high = axis.max.value_or(data.high);
  if (!std::isfinite(low) || !std::isfinite(high)) return {log ? 0.1 : 0.0, 1.0, log};
  if (!(high > low)) widen(low, high, log);
  const double room = log ? std::pow(high / low, margin) : (high - low) * margin;
  const auto below = [&](double value) { return log ? value / room : value - room; };
  const auto above = [&](double value) { return log ? value * room : value + room; };
  low = axis.min ? low : below(low);
  high = axis.max ? high : above(high);
  return {low, high, log};
}

struct Mappings {
  Mapping x, y;
};

Mappings mappings(const Figure& figure) {
  const bool log_x = figure.x.scale == AxisScale::log, log_y = figure.y.scale == AxisScale::log;
  Extent x, y;
  for (const Curve& curve : figure.curves) {
    x.add(curve.x, log_x);
    if (curve.mark != Mark::ticks) y.add(curve.y, log_y);
  }
  for (const Band& band : figure.bands) {
    x.add(band.x, log_x);
    y.add(band.lower, log_y);
    y.add(band.upper, log_y);
  }
  for (const Level& level : figure.levels) y.add(level.y, log_y);
  return {mapping(figure.x, x, 0.0), mapping(figure.y, y, 0.05)};
}

using Out = std::back_insert_iterator<std::string>;

void point(Out out, const Mappings& map, double x, double y) {
  fmt::format_to(out, "{:.2f},{:.2f} ", map.x(x), map.y(y));
}

double text_width(std::string_view text) {
  return letter * static_cast<double>(letters(text));
}

// Name by which the page's script finds the shapes of a curve and labels it.
std::string data_name(const std::string& label) {
  return label.empty() ? "" : fmt::format(" data-name=\"{}\"", escaped(label));
}

std::string_view stroke(Mark mark) {
  if (mark == Mark::dashes) return "pm-line pm-dashes";
  return mark == Mark::thin ? "pm-line pm-thin" : "pm-line";
}

void draw_line(std::string& text, const Mappings& map, const Curve& curve) {
  const Polyline line = thinned(curve.x, curve.y);
  const Out out(text);
  fmt::format_to(out, "<path class=\"{} pm-{}\"{} d=\"", stroke(curve.mark), name_of(curve.ink),
                 data_name(curve.label));
  bool pen_down = false;
  for (std::size_t k = 0; k < line.x.size(); ++k) {
    if (!map.x.shows(line.x[k]) || !map.y.shows(line.y[k])) {
      pen_down = false;
      continue;
    }
    // A single value between two gaps is drawn, too: h0 with round caps is a dot.
    fmt::format_to(out, "{}", pen_down ? "" : "M");
    point(out, map, line.x[k], line.y[k]);
    if (!pen_down) fmt::format_to(out, "h0 L");
    if (!pen_down) point(out, map, line.x[k], line.y[k]);
    pen_down = true;
  }
  text += "\"/>\n";
}

void draw_points(std::string& text, const Mappings& map, const Curve& curve) {
  const Polyline line = thinned(curve.x, curve.y);
  const std::string name = data_name(curve.label);
  for (std::size_t k = 0; k < line.x.size(); ++k) {
    if (!map.x.shows(line.x[k]) || !map.y.shows(line.y[k])) continue;
    fmt::format_to(Out(text),
                   "<circle class=\"pm-fill pm-{}\"{} cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"3\"/>\n",
                   name_of(curve.ink), name, map.x(line.x[k]), map.y(line.y[k]));
  }
}

void draw_ticks(std::string& text, const Mappings& map, const Curve& curve) {
  std::set<int> columns;  // drawn once each, however many events fall into it
  for (const double x : curve.x) {
    if (map.x.holds(x)) columns.insert(static_cast<int>(std::lround(map.x(x))));
  }
  fmt::format_to(Out(text), "<path class=\"pm-line pm-events pm-{}\" d=\"", name_of(curve.ink));
  for (const int column : columns) {
    fmt::format_to(Out(text), "M{},{:.1f}v-9", column, map.y.from);
  }
  text += "\"/>\n";
}

void draw(std::string& text, const Mappings& map, const Curve& curve) {
  PM_EXPECTS(curve.x.size() == curve.y.size() || curve.mark == Mark::ticks);
  switch (curve.mark) {
    case Mark::line:
    case Mark::dashes:
    case Mark::thin:
      draw_line(text, map, curve);
      break;
    case Mark::points:
      draw_points(text, map, curve);
      break;
    case Mark::ticks:
      draw_ticks(text, map, curve);
      break;
  }
}

// One closed path for each part of the band without a gap.
void draw(std::string& text, const Mappings& map, const Band& band) {
  const Envelope area = thinned_band(band.x, band.lower, band.upper);
  const auto shown = [&](std::size_t k) {
    return map.x.shows(area.x[k]) && map.y.shows(area.lower[k]) && map.y.shows(area.upper[k]);
  };
  fmt::format_to(Out(text), "<path class=\"pm-band pm-{}\"{} d=\"", name_of(band.ink),
                 data_name(band.label));
  for (std::size_t begin = 0; begin < area.x.size();) {
    std::size_t end = begin;
    while (end < area.x.size() && shown(end)) ++end;
    if (end > begin) {
      text += 'M';
      for (std::size_t k = begin; k < end; ++k) point(Out(text), map, area.x[k], area.upper[k]);
      for (std::size_t k = end; k-- > begin;) point(Out(text), map, area.x[k], area.lower[k]);
      text += "Z ";
    }
    begin = end + 1;
  }
  text += "\"/>\n";
}

void draw(std::string& text, const Mappings& map, const Level& level) {
  if (!map.y.holds(level.y)) return;
  fmt::format_to(Out(text), "<path class=\"pm-level\" d=\"M{:.1f},{:.1f}H{:.1f}\"/>\n", map.x.from,
                 map.y(level.y), map.x.to);
}

// A label that would extend beyond the plot is moved to the other side of its dot.
void draw(std::string& text, const Mappings& map, const Callout& callout) {
  if (!map.x.holds(callout.x) || !map.y.holds(callout.y)) return;
  const double x = map.x(callout.x), y = map.y(callout.y);
  if (callout.bare) {
    fmt::format_to(Out(text),
                   "<text class=\"pm-callout pm-mid pm-{}\" data-dy=\"4\" x=\"{:.1f}\" "
                   "y=\"{:.1f}\">{}</text>\n",
                   name_of(callout.ink), x, y + 4.0, escaped(callout.text));
    return;
  }
  const double wide = 10.0 + text_width(callout.text);
  const bool turned = x + wide > map.x.to || (callout.left && x - wide > map.x.from);
  const double dx = turned ? -7.0 : 7.0, dy = callout.below ? 17.0 : -7.0;
  fmt::format_to(Out(text),
                 "<circle class=\"pm-fill pm-{0}\" cx=\"{1:.1f}\" cy=\"{2:.1f}\" r=\"3.5\"/>"
                 "<text class=\"pm-callout{3} pm-{0}\" data-dx=\"{4}\" data-dy=\"{5}\" "
                 "x=\"{6:.1f}\" y=\"{7:.1f}\">{8}</text>\n",
                 name_of(callout.ink), x, y, turned ? " pm-end" : "", dx, dy, x + dx, y + dy,
                 escaped(callout.text));
}

std::vector<Tick> ticks_of(const Mapping& map, const Axis& axis, int most) {
  if (axis.scale == AxisScale::bare) return {};
  return map.log ? log_ticks(map.low, map.high, most) : linear_ticks(map.low, map.high, most);
}

// Faint lines at 2 … 9 times each power of ten, which make a log scale readable.
void draw_minor_grid(std::string& text, const Mapping& map, const Mapping& across, bool upright) {
  constexpr double most_decades = 8.0;
  if (!map.log || std::log10(map.high / map.low) > most_decades) return;
  text += "<path class=\"pm-grid pm-minor\" d=\"";
  const auto last = static_cast<int>(std::floor(std::log10(map.high)));
  for (auto power = static_cast<int>(std::floor(std::log10(map.low))); power <= last; ++power) {
    for (int digit = 2; digit < 10; ++digit) {
      const double value = digit * std::pow(10.0, power);
      if (!map.holds(value)) continue;
      if (upright)
        fmt::format_to(Out(text), "M{:.1f},{:.1f}V{:.1f}", map(value), across.from, across.to);
      else
        fmt::format_to(Out(text), "M{:.1f},{:.1f}H{:.1f}", across.from, map(value), across.to);
    }
  }
  text += "\"/>\n";
}

void draw_axes(std::string& text, const Mappings& map, const Figure& figure) {
  const Out out(text);
  text += "<g class=\"pm-scale\">\n";
  draw_minor_grid(text, map.x, map.y, true);
  draw_minor_grid(text, map.y, map.x, false);
  for (const Tick& tick :
       ticks_of(map.y, figure.y, std::max(3, static_cast<int>(figure.height / 48.0)))) {
    const double y = map.y(tick.value);
    fmt::format_to(out,
                   "<path class=\"pm-grid\" d=\"M{0:.1f},{1:.1f}H{2:.1f}\"/>"
                   "<text class=\"pm-tick pm-end\" x=\"{3:.1f}\" y=\"{4:.1f}\">{5}</text>\n",
                   map.x.from, y, map.x.to, left - 8.0, y + 4.0, escaped(tick.label));
  }
  for (const Tick& tick : ticks_of(map.x, figure.x, 10)) {
    const double x = map.x(tick.value);
    fmt::format_to(out,
                   "<path class=\"pm-grid\" d=\"M{0:.1f},{1:.1f}V{2:.1f}\"/>"
                   "<text class=\"pm-tick pm-mid\" x=\"{0:.1f}\" y=\"{3:.1f}\">{4}</text>\n",
                   x, map.y.from, map.y.to, map.y.from + 18.0, escaped(tick.label));
  }
  text += "</g>\n";
  if (figure.x.scale == AxisScale::bare) return;
  fmt::format_to(out,
                 "<path class=\"pm-axis\" d=\"M{0:.1f},{1:.1f}H{2:.1f}\"/>"
                 "<text class=\"pm-label pm-end\" x=\"{2:.1f}\" y=\"{3:.1f}\">{4}</text>"
                 "<text class=\"pm-label\" x=\"4\" y=\"{5:.1f}\">{6}</text>\n",
                 map.x.from, map.y.from, map.x.to, map.y.from + 40.0, escaped(figure.x.label),
                 map.y.to - 10.0, escaped(figure.y.label));
}

struct Entry {
  std::string label;
  std::string sample;  // SVG of a swatch with its left centre at 0, 0
};

std::vector<Entry> legend(const Figure& figure) {
  std::vector<Entry> entries;
  for (const Curve& curve : figure.curves) {
    if (curve.label.empty()) continue;
    std::string_view shape = "<path class=\"{2} pm-{0}\" d=\"M0,0H{1}\"/>";
    if (curve.mark == Mark::points) shape = "<circle class=\"pm-fill pm-{0}\" cx=\"12\" r=\"3\"/>";
    if (curve.mark == Mark::ticks) shape = "<path class=\"pm-line pm-{0}\" d=\"M12,-5v10\"/>";
    entries.push_back({curve.label, fmt::format(fmt::runtime(shape), name_of(curve.ink), swatch,
                                                stroke(curve.mark))});
  }
  for (const Band& band : figure.bands) {
    if (band.label.empty()) continue;
    entries.push_back(
        {band.label, fmt::format("<path class=\"pm-band pm-{}\" d=\"M0,-6h{}v12h-{}z\"/>",
                                 name_of(band.ink), swatch, swatch)});
  }
  for (const Level& level : figure.levels) {
    if (level.label.empty()) continue;
    entries.push_back(
        {level.label, fmt::format("<path class=\"pm-level\" d=\"M0,0H{}\"/>", swatch)});
  }
  return entries;
}

// Draws the legend in as many rows as necessary, above the plot so that it covers nothing, and
// returns its height.
double draw_legend(std::string& text, const std::vector<Entry>& entries) {
  double x = left, y = 0.5 * row;
  text += "<g class=\"pm-legend\">\n";
  for (const Entry& entry : entries) {
    const double wide = swatch + 8.0 + text_width(entry.label);
    if (x > left && x + wide > width - right) {
      x = left;
      y += row;
    }
    fmt::format_to(Out(text),
                   "<g transform=\"translate({:.1f},{:.1f})\">{}"
                   "<text class=\"pm-key\" x=\"{:.1f}\" y=\"4\">{}</text></g>\n",
                   x, y, entry.sample, swatch + 6.0, escaped(entry.label));
    x += wide + 18.0;
  }
  text += "</g>\n";
  return entries.empty() ? 0.0 : y + 0.5 * row;
}

// Scales by which the page's script converts coordinates to values. A figure without axes has none.
std::string scale_of(const Mappings& map, const Figure& figure) {
  if (figure.x.scale == AxisScale::bare || figure.y.scale == AxisScale::bare) return "";
  const auto axis = [](const Mapping& one) {
    return fmt::format("{} {} {:.17g} {:.17g} {}", one.from, one.to, one.low, one.high,
                       one.log ? "log" : "linear");
  };
  return fmt::format(" data-x=\"{}\" data-y=\"{}\" data-label=\"{}\"", axis(map.x), axis(map.y),
                     escaped(figure.x.label));
}

}  // namespace

std::string_view name_of(Ink ink) {
  switch (ink) {
    case Ink::blue:
      return "blue";
    case Ink::orange:
      return "orange";
    case Ink::green:
      return "green";
    case Ink::purple:
      return "purple";
    case Ink::red:
      return "red";
    case Ink::grey:
      break;
  }
  return "grey";
}

std::string svg(const Figure& figure, const std::string& id) {
  std::string body;
  const double legend_height = draw_legend(body, legend(figure));
  Mappings map = mappings(figure);
  const double top = legend_height + row + 6.0, bottom = top + figure.height;
  map.x.from = left;
  map.x.to = width - right;
  map.y.from = bottom;
  map.y.to = top;
  draw_axes(body, map, figure);
  fmt::format_to(
      Out(body),
      "<clipPath id=\"{}-box\"><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
      "height=\"{:.1f}\"/></clipPath>\n<g class=\"pm-plot\" clip-path=\"url(#{}-box)\">\n",
      id, left - 1.0, top - 1.0, width - left - right + 2.0, figure.height + 2.0, id);
  for (const Band& band : figure.bands) draw(body, map, band);
  for (const Level& level : figure.levels) draw(body, map, level);
  for (const Curve& curve : figure.curves) draw(body, map, curve);
  for (const Callout& callout : figure.callouts) draw(body, map, callout);
  return fmt::format(
      "<svg class=\"pm-figure\" viewBox=\"0 0 {:.0f} {:.0f}\"{} role=\"img\" "
      "aria-labelledby=\"{}-title {}-desc\" xmlns=\"http://www.w3.org/2000/svg\">\n"
      "<title id=\"{}-title\">{}</title>\n<desc id=\"{}-desc\">{}</desc>\n{}</g>\n</svg>\n",
      width, bottom + foot, scale_of(map, figure), id, id, id, escaped(figure.title), id,
      escaped(figure.description), body);
}

std::string figure_css() {
  return R"(:root{color-scheme:light dark;--paper:#fff;--ink:#1b2430;--soft:#5b6675;--rule:#d9dee5;
--grid:#e9edf1;--panel:#f6f8fa;--blue:#0b63a8;--orange:#b8560b;--green:#0a7a5a;--purple:#84479c;
--red:#b3261e;--grey:#6d7683}
@media screen and (prefers-color-scheme:dark){:root{--paper:#11161c;--ink:#e3e8ee;--soft:#98a3b1;
--rule:#2f3843;--grid:#222a33;--panel:#181f27;--blue:#6cb4f7;--orange:#efa14e;--green:#4ccea0;
--purple:#cfa5f2;--red:#ff8078;--grey:#98a3b1}}
.pm-figure{display:block;width:100%;height:auto;font:12.5px/1 system-ui,sans-serif;
font-variant-numeric:tabular-nums}
.pm-blue{--c:var(--blue)}.pm-orange{--c:var(--orange)}.pm-green{--c:var(--green)}
.pm-purple{--c:var(--purple)}.pm-red{--c:var(--red)}.pm-grey{--c:var(--grey)}
.pm-line{fill:none;stroke:var(--c);stroke-width:1.5;stroke-linejoin:round;stroke-linecap:round}
.pm-thin{stroke-width:1;stroke-opacity:.8}.pm-dashes{stroke-dasharray:7 5;stroke-linecap:butt}
.pm-band{fill:var(--c);fill-opacity:.2;stroke:none}.pm-fill{fill:var(--c)}
.pm-level{fill:none;stroke:var(--soft);stroke-width:1.2;stroke-dasharray:2 3}
.pm-grid{fill:none;stroke:var(--grid);stroke-width:1}.pm-minor{stroke-opacity:.55}.pm-axis{fill:none;stroke:var(--soft)}
.pm-tick,.pm-label{fill:var(--soft)}.pm-key{fill:var(--ink)}
.pm-callout{fill:var(--c);stroke:var(--paper);stroke-width:4px;paint-order:stroke}
.pm-end{text-anchor:end}.pm-mid{text-anchor:middle}
)";
}

}  // namespace proofmass::report
