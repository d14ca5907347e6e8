#include "proofmass/report/page/figure.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <regex>

#include "proofmass/report/page/page.hpp"

namespace proofmass::report::figure_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Figure plot(std::vector<double> y) {
  Figure figure{
      .title = "T", .description = "D", .x = {.label = "Time (s)"}, .y = {.label = "y (m)"}};
  std::vector<double> x(y.size());
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = static_cast<double>(k);
  figure.curves = {{"curve <1>", std::move(x), std::move(y)}};
  return figure;
}

std::ptrdiff_t count(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  return std::distance(std::sregex_iterator(text.begin(), text.end(), expression),
                       std::sregex_iterator());
}

// The path of the only curve, excluding its swatch in the legend.
std::string curve_path(const std::string& text) {
  const std::size_t at = text.find("<path class=\"pm-line", text.find("clip-path=\"url"));
  return text.substr(at, text.find("/>", at) - at);
}

TEST(Svg, BreaksALineWhereAValueIsNotFinite) {
  EXPECT_EQ(count(curve_path(svg(plot({1.0, 2.0, 3.0, 4.0}), "f")), "M"), 1);
  EXPECT_EQ(count(curve_path(svg(plot({1.0, std::nan(""), 3.0, infinity, 2.0}), "f")), "M"), 3);
}

TEST(Svg, HasNoNumberThatIsNone) {
  Figure figure = plot({std::nan(""), 1e300, -1e300, infinity});
  figure.bands = {{"b", {0.0, 1.0}, {std::nan(""), 0.0}, {1.0, infinity}}};
  const std::string text = svg(figure, "f");
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(text.find("inf"), std::string::npos);
}

TEST(Svg, IsAFigureEvenForNoValueOrOne) {
  EXPECT_NE(svg(plot({}), "f").find("</svg>"), std::string::npos);
  EXPECT_NE(svg(plot({5.0}), "f").find("</svg>"), std::string::npos);
}

TEST(Svg, LeavesWhatIsNotPositiveOffALogAxis) {
  Figure figure = plot({1.0, 10.0, 0.0, -5.0, 100.0});
  figure.y.scale = AxisScale::log;
  EXPECT_EQ(count(curve_path(svg(figure, "f")), "M"), 2);
}

TEST(Svg, NamesItselfForThoseWhoDoNotSeeIt) {
  const std::string text = svg(plot({1.0, 2.0}), "f7");
  EXPECT_NE(text.find("aria-labelledby=\"f7-title f7-desc\""), std::string::npos);
  EXPECT_NE(text.find("<title id=\"f7-title\">T</title>"), std::string::npos);
  EXPECT_NE(text.find("<desc id=\"f7-desc\">D</desc>"), std::string::npos);
}

TEST(Svg, EscapesLabels) {
  const std::string text = svg(plot({1.0, 2.0}), "f");
  EXPECT_NE(text.find("curve &lt;1&gt;"), std::string::npos);
  EXPECT_EQ(text.find("curve <1>"), std::string::npos);
}

TEST(Svg, WritesACalloutInsideThePlotAndLeavesOneOutsideAway) {
  Figure figure = plot({1.0, 2.0, 3.0});
  figure.callouts = {
      {"N <1 s>", 0.5, 2.0}, {"a rather long name", 2.0, 2.0}, {"far off", 9.0, 2.0}};
  const std::string text = svg(figure, "f");
  EXPECT_NE(text.find("N &lt;1 s&gt;"), std::string::npos);
  EXPECT_EQ(text.find("far off"), std::string::npos);
  EXPECT_EQ(count(text, "class=\"pm-callout pm-end"), 1);  // the one at the right margin
}

TEST(Svg, RulesALogAxisBetweenThePowersOfTen) {
  Figure figure = plot({1.0, 10.0, 1000.0});
  EXPECT_EQ(count(svg(figure, "f"), "pm-minor"), 0);
  figure.y.scale = AxisScale::log;
  EXPECT_EQ(count(svg(figure, "f"), "pm-minor"), 1);
}

TEST(Svg, StatesItsScalesForTheScript) {
  Figure figure = plot({1.0, 10.0, 100.0});
  figure.y = {.label = "y", .scale = AxisScale::log, .min = 1.0, .max = 1000.0};
  const std::string text = svg(figure, "f");
  EXPECT_NE(text.find("data-x=\"66 874 0 2 linear\""), std::string::npos) << text;
  EXPECT_TRUE(std::regex_search(text, std::regex("data-y=\"[0-9]+ [0-9]+ 1 1000 log\"")));
  EXPECT_NE(text.find("data-name=\"curve &lt;1&gt;\" d="), std::string::npos);
  figure.x.scale = AxisScale::bare;
  EXPECT_EQ(svg(figure, "f").find("data-x"), std::string::npos);
}

TEST(Svg, KeepsTheLegendAboveThePlot) {
  Figure figure = plot({1.0, 2.0});
  for (int k = 0; k < 12; ++k) figure.levels.push_back({"a rather long name of a level", 1.5});
  const std::string text = svg(figure, "f");
  std::smatch box;
  ASSERT_TRUE(std::regex_search(text, box, std::regex("<rect x=\"[0-9.]+\" y=\"([0-9.]+)\"")));
  const std::regex entry("translate\\(([0-9.]+),([0-9.]+)\\)");
  for (std::sregex_iterator it(text.begin(), text.end(), entry), end; it != end; ++it) {
    EXPECT_LT(std::stod((*it)[2]), std::stod(box[1]));
    EXPECT_LT(std::stod((*it)[1]), 900.0 - 200.0);
  }
}

TEST(Svg, StaysSmallHoweverLongTheSeries) {
  std::vector<double> y(1'000'000);
  for (std::size_t k = 0; k < y.size(); ++k) y[k] = std::sin(static_cast<double>(k));
  EXPECT_LT(svg(plot(std::move(y)), "f").size(), 80'000U);
}

TEST(Html, HasNoExternalResources) {
  Page page{.verb = "wheel", .title = "<x>.csv", .inputs = {"<x>.csv"}, .conclusion = "It turned."};
  page.sections = {{.heading = "H", .figures = {plot({1.0, 2.0}), plot({2.0, 1.0})}}};
  const std::string text = html(page);
  for (const char* word : {"<link", "<img", "@import", "url(http", "src="}) {
    EXPECT_EQ(text.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(count(text, "https?://"), 3);  // names of the SVG namespace, one in the script
  EXPECT_EQ(text.find("<x>.csv"), std::string::npos);
  EXPECT_NE(text.find("id=\"figure-1-title\""), std::string::npos);
  EXPECT_NE(text.find("id=\"figure-2-title\""), std::string::npos);
}

TEST(Html, HasAScriptOnlyWhereItHasFigures) {
  Page page{.verb = "wheel", .title = "t", .inputs = {}, .conclusion = "It turned."};
  page.sections = {{.heading = "H"}};
  EXPECT_EQ(count(html(page), "<script"), 0);
  page.sections.front().figures = {plot({1.0, 2.0}), plot({2.0, 1.0})};
  EXPECT_EQ(count(html(page), "<script"), 1);
}

TEST(Html, PutsTheConclusionBeforeEverythingElseAndFaultsBeforeSections) {
  Page page{.verb = "wheel", .title = "t", .inputs = {}, .conclusion = "It turned."};
  page.notes = {{Severity::info, "comma separated"}, {Severity::bad, "3 values of 3e34"}};
  page.sections = {{.heading = "Angle"}};
  const std::string text = html(page);
  EXPECT_LT(text.find("It turned."), text.find("3 values of 3e34"));
  EXPECT_LT(text.find("3 values of 3e34"), text.find("Angle"));
  EXPECT_LT(text.find("Angle"), text.find("comma separated"));
}

}  // namespace
}  // namespace proofmass::report::figure_test
